#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lodestar {

/// The pre-hash string of one EPCIS 2.0 event (GS1 Core Business Vocabulary 2.0, section 8.9.2): its fields in
/// canonical order, lists sorted, vocabulary as full URIs, then the user's extensions. eventID, recordTime and
/// errorDeclaration do not take part.
///
/// Expects what epcis.hpp writes: times in UTC with milliseconds, keys as canonical GS1 Digital Link URIs, and
/// each prefix of an extension's name in `namespaces` (prefix -> URI). A list of sensor elements goes without the
/// list's own name: so version 2.0 has it in both reference implementations; version 2.1 puts it in. Two fields that
/// the bridge never writes, persistentDisposition and ilmd, are left out here.
std::string event_pre_hash(const nlohmann::json& event, const nlohmann::json& namespaces);

/// The same as an eventID: "ni:///sha-256;<64 hex digits>?ver=CBV2.0" (RFC 6920).
std::string event_hash_id(const nlohmann::json& event, const nlohmann::json& namespaces);

}  // namespace lodestar
