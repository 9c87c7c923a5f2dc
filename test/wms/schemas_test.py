#!/usr/bin/env python3
"""Holds the example documents of test/data/wms against the official schemas, formats asserted.

Usage: schemas_test.py epcis|vda5050 <folder of the examples> <schema file, or folder of the schemas>

The examples are what the code writes (unit_wms compares them). GS1's schema may not be part of this project: whoever
tests gives its path, here or (then an empty one here) as LODESTAR_EPCIS_SCHEMA. Exit code 77 means skipped, with the
reason.
"""
import copy
import datetime
import glob
import json
import os
import re
import sys


def skip(reason):
    print("SKIPPED: " + reason)
    sys.exit(77)


try:
    import jsonschema
    import rfc3987
except ImportError as missing:
    skip("%s (Debian: python3-jsonschema, python3-rfc3987)" % missing)

FORMATS = jsonschema.FormatChecker(formats=())


@FORMATS.checks("uri")
def is_uri(text):
    return not isinstance(text, str) or rfc3987.match(text, rule="URI") is not None


@FORMATS.checks("date-time", raises=ValueError)
def is_date_time(text):
    if isinstance(text, str):
        if not re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)$", text):
            return False
        datetime.datetime.fromisoformat(text.replace("Z", "+00:00"))
    return True


def load(path):
    with open(path, encoding="utf-8-sig") as file:
        return json.load(file)


def faults(schema, document):
    validator = jsonschema.validators.validator_for(schema)(schema, format_checker=FORMATS)
    return ["/".join(str(step) for step in fault.absolute_path) + ": " + fault.message[:300]
            for fault in validator.iter_errors(document)]


def broken(document):
    """Copies of the document with one thing wrong each: a schema that lets them pass asserts nothing."""
    for path, value in ((("creationDate",), "yesterday"), (("timestamp",), "yesterday"),
                        (("epcisBody", "eventList", 0, "eventTime"), "2026-13-01T00:00:00Z"),
                        (("epcisBody", "eventList", 0, "readPoint", "id"), "not a uri"),
                        (("epcisBody", "eventList", 0, "action"), "MOVE"), (("connectionState",), "MAYBE"),
                        (("agvPosition", "localizationScore"), 2), (("operatingMode",), "DRIVING")):
        out = copy.deepcopy(document)
        place = out
        try:
            for step in path[:-1]:
                place = place[step]
            place[path[-1]]
        except (KeyError, IndexError):
            continue
        place[path[-1]] = value
        yield path, out


def main():
    kind, examples, schemas = sys.argv[1:4]
    schemas = schemas or os.environ.get("LODESTAR_EPCIS_SCHEMA", "")
    if not os.path.exists(schemas):
        skip("no schema at '%s': docs/wms_integration.md says where it is and how to name it" % schemas)
    paths = sorted(glob.glob(os.path.join(examples, kind + "_*.json")))
    checked = refused = 0
    failed = []
    for path in paths:
        name = os.path.basename(path)[len(kind) + 1:-len(".json")].split("_")[0]
        schema = load(schemas if kind == "epcis" else os.path.join(schemas, name + ".schema"))
        document = load(path)
        failed += ["%s: %s" % (path, fault) for fault in faults(schema, document)]
        checked += 1
        for place, wrong in broken(document):
            refused += 1
            if not faults(schema, wrong):
                failed.append("%s: the schema lets a wrong %s pass" % (path, place))
    if not checked or not refused:
        failed.append("no examples in " + examples)
    print("\n".join(failed) or "%d documents are valid, %d broken ones are not" % (checked, refused))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
