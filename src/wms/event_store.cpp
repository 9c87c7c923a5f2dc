#include "lodestar/wms/event_store.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cerrno>

#include "lodestar/wms/ballast.hpp"
#include "store_schema.hpp"

namespace lodestar {
namespace {

using SQLite::Statement;

/// What the job gives; damage by its own name.
template <class Job>
auto checked(Job job) {
  try {
    return job();
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) throw StoreCorrupt(error.what());
    throw;
  }
}

/// One that a busy file left half done would keep every later transaction from its commit.
struct ResetAtEnd {
  ~ResetAtEnd() { statement.tryReset(); }
  Statement& statement;
};

/// Bound, run, and ready for the next time.
template <class... Values>
int execute(Statement& statement, const Values&... values) {
  statement.tryReset();
  int index = 0;
  (statement.bind(++index, values), ...);
  const ResetAtEnd reset{statement};
  return statement.exec();
}

bool has_place(PalletState state) { return state == PalletState::kStanding || state == PalletState::kUncertain; }

std::int64_t signed_of(std::uint64_t number) { return static_cast<std::int64_t>(number); }
std::int64_t ticks(Duration duration) { return static_cast<std::int64_t>(duration.count()); }
std::uint64_t unsigned_of(const SQLite::Column& column) { return static_cast<std::uint64_t>(column.getInt64()); }

void require_sound(SQLite::Database& database, const char* check) {
  const std::string verdict = database.execAndGet(check).getString();
  if (verdict != "ok") throw StoreCorrupt(verdict);
}

SQLite::Database open_database(const std::string& path) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  require_sound(database, "PRAGMA quick_check(1)");
  database.exec("PRAGMA journal_mode = WAL");
  database.exec("PRAGMA synchronous = FULL");
  // Above what the log grows to between two checkpoints (4 MB): cut off each time, it would have to grow anew, and an
  // fsync of a file that grew takes twice as long.
  database.exec("PRAGMA journal_size_limit = 8388608");
  migrate(database);
  require_sound(database, "SELECT rtreecheck('place')");  // quick_check takes its nodes for any blob
  return database;
}

}  // namespace

struct EventStore::Sql {
  explicit Sql(const StoreParams& params)
      : database(open_database(params.path)), ballast(params.path + ".ballast", params.ballast_bytes) {}

  /// Does not throw: it is also set on the way out of a job that threw.
  void limit(std::int64_t pages) {
    const std::string text = "PRAGMA max_page_count = " + std::to_string(pages);
    sqlite3_exec(database.getHandle(), text.c_str(), nullptr, nullptr, nullptr);
  }

  /// The limit of pages, or the disk; the shared memory of the log tells it as an input/output error.
  bool out_of_room(const SQLite::Exception& error) {
    return error.getErrorCode() == SQLITE_FULL ||
           (error.getErrorCode() == SQLITE_IOERR && sqlite3_system_errno(database.getHandle()) == ENOSPC);
  }

  struct LimitAtEnd {
    ~LimitAtEnd() { sql.limit(pages); }
    Sql& sql;
    std::int64_t pages;
  };

  struct RollBackAtEnd {
    ~RollBackAtEnd() {
      if (sqlite3_get_autocommit(sql.database.getHandle()) != 0) return;
      sql.roll_back.tryReset();
      sql.roll_back.tryExecuteStep();
      sql.roll_back.tryReset();
    }
    Sql& sql;
  };

  struct Row {
    StoredDocument stored;
    bool frozen, corrects;
    WallClock clock;
  };
  /// @param boot_step of the clock in this boot, as it may not be written yet
  std::vector<Row> rows(std::uint64_t first, std::size_t most, const std::string& boot, Duration boot_step) {
    get_events.tryReset();
    get_events.bind(1, signed_of(first));
    get_events.bind(2, static_cast<std::int64_t>(most));
    get_events.bind(3, boot);
    get_events.bind(4, ticks(boot_step));
    std::vector<Row> out;
    while (get_events.executeStep())
      out.push_back({{unsigned_of(get_events.getColumn(0)), get_events.getColumn(1).getString()},
                     get_events.getColumn(2).getInt() != 0,
                     get_events.getColumn(3).getInt64() > 0,
                     {get_events.getColumn(4).getInt() != 0, Duration(get_events.getColumn(5).getInt64())}});
    get_events.tryReset();
    return out;
  }

  /// All that is frozen of the pallet that a correction corrects, and of the one that it is told of.
  std::vector<std::string> told_of_the_corrected(std::uint64_t sequence) {
    get_told.tryReset();
    get_told.bind(1, signed_of(sequence));
    std::vector<std::string> out;
    while (get_told.executeStep()) out.push_back(get_told.getColumn(0).getString());
    get_told.tryReset();
    return out;
  }

  std::string frozen(const Row& row, const Freeze& freeze) {
    const auto& [sequence, draft] = row.stored;
    StoredDraft whole{sequence, draft, row.clock, {}};
    if (row.corrects) whole.told = told_of_the_corrected(sequence);
    std::string document = freeze(whole);
    execute(freeze_event, document, signed_of(sequence));
    return document;
  }

  std::optional<std::string> meta(const std::string& key) {
    Statement get(database, "SELECT value FROM meta WHERE key = ?");
    get.bind(1, key);
    if (!get.executeStep()) return std::nullopt;
    return get.getColumn(0).getString();
  }

  SQLite::Database database;
  Ballast ballast;
  Statement begin{database, "BEGIN"}, commit{database, "COMMIT"}, roll_back{database, "ROLLBACK"};
  Statement put_meta{database, "INSERT INTO meta VALUES(?, ?) ON CONFLICT(key) DO UPDATE SET value = excluded.value"};
  Statement put_life{database,
                     "INSERT INTO life VALUES(?, ?, ?) ON CONFLICT(life) DO UPDATE"
                     " SET heard = excluded.heard, sequence = excluded.sequence WHERE excluded.heard > heard"};
  Statement put_event{database,
                      "INSERT INTO event(sequence, heard, pallet, corrects, document, boot, clock_step_ns,"
                      " synchronised) VALUES(?, ?, ?, ?, ?, ?, ?, ?)"};
  Statement put_pallet{database,
                       "INSERT INTO pallet(id, sscc, state, zone, level, sequence) VALUES(?, ?, ?, ?, ?, ?)"
                       " ON CONFLICT(id) DO UPDATE SET sscc = excluded.sscc, state = excluded.state,"
                       " zone = excluded.zone, level = excluded.level, sequence = excluded.sequence"};
  Statement drop_pallet{database, "DELETE FROM pallet WHERE id = ?"};
  Statement drop_place{database, "DELETE FROM place WHERE key = (SELECT key FROM pallet WHERE id = ?)"};
  Statement put_place{database, "REPLACE INTO place SELECT key, ?2, ?2, ?3, ?3, ?4, ?4 FROM pallet WHERE id = ?1"};
  Statement get_events{database,
                       "SELECT sequence, document, frozen, corrects, synchronised,"
                       " clock_step_ns + CASE boot WHEN ?3 THEN ?4 ELSE IFNULL(step_ns, 0) END"
                       " FROM event LEFT JOIN clock USING(boot) WHERE sequence >= ?1"
                       " ORDER BY sequence LIMIT ?2"};
  Statement freeze_event{database, "UPDATE event SET document = ?, frozen = 1 WHERE sequence = ?"};
  Statement get_told{
      database,
      "SELECT document FROM event INDEXED BY event_pallet WHERE sequence < ?1 AND frozen = 1 AND pallet IN("
      "(SELECT pallet FROM event WHERE sequence = ?1),"
      "(SELECT told.pallet FROM event AS told JOIN event AS correction ON told.heard = correction.corrects"
      " WHERE correction.sequence = ?1 AND told.sequence < ?1 ORDER BY told.sequence DESC LIMIT 1))"
      " ORDER BY sequence"};
  Statement forget_events{database, "DELETE FROM event WHERE sequence BETWEEN ? AND ?"};
  Statement put_clock{database, "REPLACE INTO clock VALUES(?, ?, ?)"};
  Statement forget_clocks{database, "DELETE FROM clock WHERE boot <> ?"};
};

EventStore::EventStore(const StoreParams& params, const std::string& new_stream) : params_(params) {
  checked([&] {
    sql_ = std::make_unique<Sql>(params_);
    sql_->limit(params_.max_pages);
    load(new_stream);
  });
}

EventStore::~EventStore() = default;

void EventStore::load(const std::string& new_stream) {
  const auto stream = sql_->meta("stream");
  if (!stream) execute(sql_->put_meta, "stream", new_stream);
  stream_ = stream.value_or(new_stream);
  acknowledged_ = std::stoull(sql_->meta("acknowledged").value_or("0"));
  Statement clock(sql_->database, "SELECT offset_ns, step_ns FROM clock WHERE boot = ?");
  clock.bind(1, params_.boot);
  if (clock.executeStep()) {
    clock_offset_ = Duration(clock.getColumn(0).getInt64());
    clock_step_ = Duration(clock.getColumn(1).getInt64());
  }
  Statement newest(sql_->database, "SELECT sequence, heard, life FROM life ORDER BY sequence DESC LIMIT 1");
  last_ = std::max(acknowledged_, unsigned_of(sql_->database.execAndGet("SELECT IFNULL(MAX(sequence), 0) FROM event")));
  if (newest.executeStep()) last_heard_ = {unsigned_of(newest.getColumn(1)), newest.getColumn(2).getString()};
}

std::uint64_t EventStore::handed_over() const {
  return checked([&] {
    const auto newest = sql_->database.execAndGet("SELECT IFNULL(MAX(sequence), 0) FROM event WHERE frozen = 1");
    return std::max(acknowledged_, unsigned_of(newest));
  });
}

/// One transaction. @return false: no room, nothing was changed
template <class Job>
bool EventStore::run(Job job) {
  return checked([&] {
    try {
      const Sql::RollBackAtEnd unless_committed{*sql_};
      execute(sql_->begin);
      job();
      execute(sql_->commit);
      return true;
    } catch (const SQLite::Exception& error) {
      if (!sql_->out_of_room(error)) throw;
      return false;
    }
  });
}

/// The same with all the room that is kept back. The ballast comes back when there is room for it again.
template <class Job>
bool EventStore::run_with_reserve(Job job) {
  const Sql::LimitAtEnd without_reserve{*sql_, params_.max_pages};
  sql_->limit(params_.max_pages + params_.reserve_pages);
  if (run(job)) return true;
  if (!sql_->ballast.held()) return false;
  sql_->ballast.release();
  return run(job);
}

Recorded EventStore::record(const PalletChange& change, const std::string& draft, const WallClock& clock) {
  Recorded result = Recorded::kNew;
  const auto job = [&] { result = insert(change, draft, clock); };
  // Without ballast there is only the room that emptying the queue needs.
  full_ =
      !keep_clock() || (!(sql_->ballast.hold() && run(job)) && !(forget_history() && sql_->ballast.hold() && run(job)));
  if (full_) return Recorded::kFull;
  if (result == Recorded::kKnown) return result;
  ++last_;
  last_heard_ = heard_event(change);
  return result;
}

Recorded EventStore::insert(const PalletChange& change, const std::string& draft, const WallClock& clock) {
  const int is_new = execute(sql_->put_life, change.life, signed_of(change.sequence), signed_of(last_ + 1));
  if (is_new == 0) return Recorded::kKnown;
  execute(sql_->put_event, signed_of(last_ + 1), signed_of(change.sequence), change.pallet.id,
          signed_of(change.corrects), draft, params_.boot, ticks(clock.step - clock_step_), clock.synchronised ? 1 : 0);
  put_pallet(change);
  return Recorded::kNew;
}

/// A lift leaves the old place where it is: the state says that the pallet does not stand there.
void EventStore::put_pallet(const PalletChange& change) {
  const Pallet& pallet = change.pallet;
  if (pallet.state == PalletState::kGone) return forget_pallet(pallet.id);
  execute(sql_->put_pallet, pallet.id, pallet.sscc, static_cast<int>(pallet.state), pallet.zone, pallet.level,
          signed_of(last_ + 1));
  if (!has_place(pallet.state)) return;
  const auto p = pallet.T_map_pallet.translation();
  execute(sql_->put_place, pallet.id, p.x(), p.y(), p.z());
}

void EventStore::forget_pallet(const std::string& id) {
  execute(sql_->drop_place, id);
  execute(sql_->drop_pallet, id);
}

/// What is acknowledged is the only thing that may go. @return whether any did
bool EventStore::forget_history() {
  if (acknowledged_ == 0) return false;
  int forgotten = 0;
  const bool done = run_with_reserve([&] { forgotten = execute(sql_->forget_events, 0, signed_of(acknowledged_)); });
  return done && forgotten > 0;
}

std::vector<StoredDocument> EventStore::documents(std::uint64_t first, std::size_t most, const Freeze& freeze) {
  const std::vector<Sql::Row> rows = checked([&] { return sql_->rows(first, most, params_.boot, clock_step_); });
  std::vector<StoredDocument> out;
  for (const Sql::Row& row : rows) out.push_back(row.stored);
  const auto draft = std::find_if(rows.begin(), rows.end(), [](const Sql::Row& row) { return !row.frozen; });
  const auto frozen = static_cast<std::size_t>(draft - rows.begin());
  std::size_t ready = rows.size();
  const auto freeze_them = [&] {
    return run_with_reserve([&] {
      for (std::size_t i = frozen; i < ready; ++i)
        if (!rows[i].frozen) out[i].document = sql_->frozen(rows[i], freeze);
    });
  };
  while (ready > frozen && !freeze_them() && !(forget_history() && freeze_them()))
    ready = frozen + (ready - frozen) / 2;
  out.resize(ready);
  return out;
}

bool EventStore::acknowledge(std::uint64_t sequence) {
  if (sequence <= acknowledged_ || sequence > last_) return true;
  const auto outside_history = [this](std::uint64_t number) {
    return signed_of(std::max(number, params_.history) - params_.history);
  };
  const bool done = run_with_reserve([&] {
    execute(sql_->put_meta, "acknowledged", std::to_string(sequence));
    execute(sql_->forget_events, outside_history(acknowledged_), outside_history(sequence));
    if (sequence == last_) execute(sql_->forget_clocks, params_.boot);
  });
  if (!done) return false;
  acknowledged_ = sequence;
  sql_->ballast.hold();
  return true;
}

bool EventStore::mark_clock_step(Duration step, Duration offset) {
  clock_step_ += step;
  clock_offset_ = offset;
  clock_is_kept_ = false;
  return keep_clock();
}

bool EventStore::keep_clock() {
  if (clock_is_kept_) return true;
  clock_is_kept_ =
      run_with_reserve([&] { execute(sql_->put_clock, params_.boot, ticks(*clock_offset_), ticks(clock_step_)); });
  return clock_is_kept_;
}

std::vector<StoredPallet> EventStore::pallets_in(const MapBox& box) {
  return checked([&] {
    Statement get(sql_->database,
                  "SELECT id, sscc, zone, state, level, sequence FROM place JOIN pallet USING(key)"
                  " WHERE high_x >= ? AND low_x <= ? AND high_y >= ? AND low_y <= ? AND high_z >= ? AND low_z <= ?"
                  " AND state <> ? ORDER BY id");
    get.bind(7, static_cast<int>(PalletState::kOnFork));
    for (int axis = 0; axis < 3; ++axis) {
      get.bind(2 * axis + 1, box.low_m[axis]);
      get.bind(2 * axis + 2, box.high_m[axis]);
    }
    std::vector<StoredPallet> out;
    while (get.executeStep())
      out.push_back({get.getColumn(0).getString(), get.getColumn(1).getString(), get.getColumn(2).getString(),
                     static_cast<PalletState>(get.getColumn(3).getInt()), get.getColumn(4).getInt(),
                     unsigned_of(get.getColumn(5))});
    return out;
  });
}

}  // namespace lodestar
