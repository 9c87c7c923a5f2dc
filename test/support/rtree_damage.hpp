#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>

namespace lodestar::test {

/// The root of the R*Tree says that it has 65535 cells, which quick_check does not see.
inline void damage_rtree(const std::string& path) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE);
  database.exec(
      "UPDATE place_node SET data = CAST(substr(data, 1, 2) || x'ffff' || substr(data, 5) AS BLOB)"
      " WHERE nodeno = 1");
}

}  // namespace lodestar::test
