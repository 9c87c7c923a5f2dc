#include "store_schema.hpp"

#include <iterator>
#include <string>

namespace lodestar {
namespace {

// Never changed once released: a new version is a new entry.
const char* const kMigrations[] = {
    R"(CREATE TABLE meta(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
       CREATE TABLE event(
         sequence INTEGER PRIMARY KEY,
         heard INTEGER NOT NULL,     -- the tracker's own number
         stamp_ns INTEGER NOT NULL,
         pallet TEXT NOT NULL,
         corrects INTEGER NOT NULL,  -- the tracker's number of the event that this one calls wrong
         document TEXT NOT NULL,     -- a draft until frozen
         frozen INTEGER NOT NULL DEFAULT 0,
         UNIQUE(heard, stamp_ns, pallet));
       CREATE TABLE pallet(
         key INTEGER PRIMARY KEY, id TEXT UNIQUE NOT NULL, sscc TEXT NOT NULL, state INTEGER NOT NULL,
         zone TEXT NOT NULL, level INTEGER NOT NULL, sequence INTEGER NOT NULL);
       CREATE VIRTUAL TABLE place USING rtree(key, low_x, high_x, low_y, high_y, low_z, high_z);)",
    // A clock that was set.
    R"(ALTER TABLE event ADD COLUMN boot TEXT NOT NULL DEFAULT '';
       ALTER TABLE event ADD COLUMN clock_step_ns INTEGER NOT NULL DEFAULT 0;)",
    // What a step of the clock writes is as small with many events as with few: it has to find room when nothing else
    // does. An event was set wrong by its own clock_step_ns and its boot's.
    R"(ALTER TABLE event ADD COLUMN synchronised INTEGER NOT NULL DEFAULT 1;
       CREATE TABLE clock(boot TEXT PRIMARY KEY, offset_ns INTEGER NOT NULL, step_ns INTEGER NOT NULL) WITHOUT ROWID;
       CREATE INDEX event_pallet ON event(pallet);)",
    // Up to which of the tracker's numbers all is recorded, for each of its lives: no event is known by a row of its
    // own.
    R"(CREATE TABLE life(life TEXT PRIMARY KEY, heard INTEGER NOT NULL, sequence INTEGER NOT NULL) WITHOUT ROWID;
       DROP INDEX event_pallet;
       ALTER TABLE event RENAME TO old_event;
       CREATE TABLE event(
         sequence INTEGER PRIMARY KEY,
         heard INTEGER NOT NULL,          -- the tracker's own number
         pallet TEXT NOT NULL,
         corrects INTEGER NOT NULL,       -- the tracker's number of the event that this one calls wrong
         document TEXT NOT NULL,          -- a draft until frozen
         frozen INTEGER NOT NULL DEFAULT 0,
         boot TEXT NOT NULL,
         clock_step_ns INTEGER NOT NULL,
         synchronised INTEGER NOT NULL);
       INSERT INTO event SELECT sequence, heard, pallet, corrects, document, frozen, boot, clock_step_ns, synchronised
         FROM old_event WHERE frozen < 2;
       DROP TABLE old_event;
       CREATE INDEX event_pallet ON event(pallet);)"};

}  // namespace

void migrate(SQLite::Database& database) {
  constexpr int kVersion = static_cast<int>(std::size(kMigrations));
  const int found = database.execAndGet("PRAGMA user_version").getInt();
  if (found > kVersion)
    throw SQLite::Exception("the file has schema version " + std::to_string(found) + ", this program knows " +
                            std::to_string(kVersion));
  for (int version = found; version < kVersion; ++version) {
    SQLite::Transaction transaction(database);
    database.exec(kMigrations[version]);
    database.exec("PRAGMA user_version = " + std::to_string(version + 1));
    transaction.commit();
  }
}

}  // namespace lodestar
