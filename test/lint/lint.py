#!/usr/bin/python3
"""Checks what a compiler does not: who includes whom, and that files other than code can be read.

Usage: lint.py <source folder>. Prints each fault as file:line: what, and ends with the number of faults' verdict.
"""
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import yaml

# Headers of ROS, and the generated ones of this package's messages (UpperCamel directly in lodestar/).
ROS_HEADER = re.compile(
    r"(ros|roscpp|rosbag|rosconsole|nodelet|pluginlib|tf2\w*|tf|\w+_msgs|message_filters|image_transport|cv_bridge|"
    r"camera_info_manager|diagnostic_updater|dynamic_reconfigure|std_srvs|rostest)/|lodestar/[A-Z]\w*\.h$")
# What programs without ROS may see of the edge.
ROS_FREE_EDGE = {"lodestar/ros/bag/recording.hpp"}
EDGE = {"ros", "apps"}


class Faults(list):
    def add(self, path, line, what):
        self.append("%s:%d: %s" % (path, line, what))


def text_of(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def files(root, *folders):
    """Paths of the files in these folders, from root, sorted."""
    found = []
    for folder in folders:
        for place, _, names in os.walk(os.path.join(root, folder)):
            found += [os.path.relpath(os.path.join(place, name), root) for name in names]
    return sorted(path for path in found if not path.endswith(".pyc"))


def read_rooms(root):
    """The table of ARCHITECTURE.md: module -> (folder, what it may include; None: everything but the edge)."""
    rooms = {}
    in_table = False
    for line in text_of(root, "ARCHITECTURE.md").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if cells == ["module", "folder", "may include"]:
            in_table = True
        elif not line.startswith("|"):
            in_table = False
        elif in_table and not set(cells[0]) <= set("-: "):
            rooms[cells[0]] = (cells[1], None if cells[2] == "*" else set(cells[2].split()))
    return rooms


def room_of(rooms, path):
    """The module that a path below src/ or include/lodestar/ belongs to."""
    for module, (folder, _) in rooms.items():
        if path.startswith(folder + "/"):
            return module
    return None


def may_see(rooms, module, other):
    allowed = rooms[module][1]
    if module == other or module in EDGE and allowed is None:
        return True
    return other not in EDGE if allowed is None else other in allowed


def check_includes(root, rooms, faults):
    for path in files(root, "src", "include/lodestar"):
        if not path.endswith((".hpp", ".cpp", ".h", ".in")):
            continue
        inner = re.sub(r"^(src|include/lodestar)/", "", path)
        module = room_of(rooms, inner)
        if module is None:
            faults.add(path, 1, "lies in no module of ARCHITECTURE.md's table: add a row, or move the file")
            continue
        ros_free = module != "ros" or re.sub("^include/", "", path) in ROS_FREE_EDGE
        for number, line in enumerate(text_of(root, path).splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*[<"]([^">]+)[">]', line)
            if not include:
                continue
            header = include.group(1)
            if ROS_HEADER.match(header):
                if ros_free:
                    faults.add(path, number, "%s includes ROS (%s): only src/ros does" % (module, header))
            elif header.startswith("opencv2/") and inner.startswith("base/"):
                faults.add(path, number, "base includes OpenCV (%s)" % header)
            elif header.startswith("lodestar/"):
                other = room_of(rooms, header[len("lodestar/"):])
                if other is None:
                    faults.add(path, number, "%s is in no module of ARCHITECTURE.md's table" % header)
                elif not may_see(rooms, module, other):
                    faults.add(path, number, "%s may not include %s (%s)" % (module, other, header))
                elif module == "apps" and other == "ros" and header not in ROS_FREE_EDGE:
                    faults.add(path, number, "apps see the edge through %s alone" % ", ".join(ROS_FREE_EDGE))


def check_links(root, rooms, faults):
    """Each module's CMake library lies in its folder and links nothing that it may not include."""
    links, shared, lines = {}, {}, {}
    text = text_of(root, "CMakeLists.txt")
    for call in re.finditer(r"lodestar_module\((\w+)\s+DIR\s+(\S+)\s+LINKS([^)]*)\)", text):
        module, folder = call.group(1), call.group(2)
        lines[module] = text.count("\n", 0, call.start()) + 1
        links[module] = set(re.findall(r"lodestar_(\w+)", call.group(3)))
        shared[module] = set(re.findall(r"lodestar_(\w+)", call.group(3).partition("PRIVATE")[0]))
        if module not in rooms or rooms[module][0] != folder:
            faults.add("CMakeLists.txt", lines[module],
                       "module %s in %s is not in ARCHITECTURE.md's table" % (module, folder))
    for module in set(rooms) - EDGE - set(links):
        faults.add("ARCHITECTURE.md", 1, "module %s of the table is not in CMakeLists.txt" % module)

    def reach(module):
        seen = set()
        todo = list(links[module])
        while todo:
            other = todo.pop()
            if other not in seen:
                seen.add(other)
                todo += shared.get(other, ())
        return seen

    for module in sorted(set(links) & set(rooms)):
        for other in sorted(reach(module)):
            if other not in rooms or not may_see(rooms, module, other):
                faults.add("CMakeLists.txt", lines[module], "%s may not link %s" % (module, other))


def check_pages(root, faults):
    """What a page links to within the project is there."""
    pages = [name for name in os.listdir(root) if name.endswith(".md")]
    for path in sorted(pages) + [path for path in files(root, "docs") if path.endswith(".md")]:
        for number, line in enumerate(text_of(root, path).splitlines(), 1):
            for target in re.findall(r"\]\(([^)\s]+)\)", line):
                target = target.partition("#")[0]
                if target and "://" not in target and \
                        not os.path.exists(os.path.join(root, os.path.dirname(path), target)):
                    faults.add(path, number, "links to %s, which is not there" % target)


def check_package(root, faults):
    """package.xml names what CMake asks catkin for."""
    package = ElementTree.parse(os.path.join(root, "package.xml")).getroot()
    named = {element.text for element in package if element.tag.endswith("depend")}
    text = text_of(root, "cmake/ros.cmake")
    components = re.search(r"set\(LODESTAR_ROS_COMPONENTS([^)]*)\)", text).group(1).split()
    for component in components:
        if component not in named:
            faults.add("package.xml", 1, "does not name %s, which cmake/ros.cmake finds" % component)


def check_readable(root, faults):
    for path in files(root, "config", "rviz", "launch", "scripts", "test", "msg", "srv", "src", "include", "docs",
                      "bench", "cmake", "cfg"):
        full = os.path.join(root, path)
        if os.path.getsize(full) > 2000000:
            faults.add(path, 1, "is larger than 2 MB")
        with open(full, "rb") as file:
            data = file.read()
        if b"\0" in data:
            continue  # a picture or a recording
        if data and not data.endswith(b"\n"):
            faults.add(path, data.count(b"\n") + 1, "does not end with a newline")
        if path.endswith((".yaml", ".rviz")) and not path.startswith("test/data/"):
            try:
                list(yaml.safe_load_all(data))
            except yaml.YAMLError as error:
                faults.add(path, getattr(error, "problem_mark", None) and error.problem_mark.line + 1 or 1,
                           "is not YAML: %s" % getattr(error, "problem", error))
        if path.endswith((".launch", ".test", ".xml")):
            try:
                ElementTree.fromstring(data)
            except ElementTree.ParseError as error:
                faults.add(path, error.position[0], "is not XML: %s" % error)
        if data.startswith(b"#!/usr/bin/env bash"):
            result = subprocess.run(["bash", "-n", full], stderr=subprocess.PIPE, universal_newlines=True)
            if result.returncode:
                faults.add(path, 1, "is not a shell script: %s" % result.stderr.strip())
            if not os.access(full, os.X_OK):
                faults.add(path, 1, "cannot be executed: chmod +x")


def lint(root):
    faults = Faults()
    rooms = read_rooms(root)
    if not rooms:
        faults.add("ARCHITECTURE.md", 1, "has no table '| module | folder | may include |'")
    check_includes(root, rooms, faults)
    check_links(root, rooms, faults)
    check_package(root, faults)
    check_pages(root, faults)
    check_readable(root, faults)
    return faults


if __name__ == "__main__":
    FOUND = lint(sys.argv[1])
    print("\n".join(FOUND) if FOUND else "No faults.")
    sys.exit(1 if FOUND else 0)
