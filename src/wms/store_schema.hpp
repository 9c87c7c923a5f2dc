#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

namespace lodestar {

/// Brings a file to the schema of this program, version by version, each in one transaction (PRAGMA user_version).
/// Throws SQLite::Exception; a file of a newer version is left as it is.
void migrate(SQLite::Database& database);

}  // namespace lodestar
