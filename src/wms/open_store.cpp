#include <cstdio>
#include <filesystem>

#include "lodestar/wms/event_store.hpp"

namespace lodestar {
namespace {

/// With its journal, which belongs to no other file.
std::string set_aside(const std::string& path) {
  std::string away;
  for (int i = 1; away.empty() || std::filesystem::exists(away); ++i) away = path + ".corrupt-" + std::to_string(i);
  for (const char* part : {"", "-wal", "-shm"})
    if (std::filesystem::exists(path + part)) std::filesystem::rename(path + part, away + part);
  return away;
}

}  // namespace

OpenedStore open_store(const StoreParams& params, const std::string& new_stream, const std::string& damage) {
  OpenedStore opened;
  opened.damage = damage;
  try {
    if (damage.empty()) opened.store = std::make_unique<EventStore>(params, new_stream);
  } catch (const StoreCorrupt& error) {
    opened.damage = error.what();
  }
  if (opened.store) return opened;
  opened.set_aside = set_aside(params.path);
  opened.store = std::make_unique<EventStore>(params, new_stream);
  return opened;
}

}  // namespace lodestar
