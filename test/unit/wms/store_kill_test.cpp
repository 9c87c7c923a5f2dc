// The store's process is killed (SIGKILL) as SQLite begins or ends a statement, another in its run each time; what was
// committed must be whole when the store is opened again. A kill leaves the kernel's caches alone: that a fall of power
// is survived too rests on SQLite's synchronous=FULL and a disk that does not lie.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <set>

#include "lodestar/wms/event_store.hpp"
#include "support/pallet_changes.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::change;
using test::uuid;

long statements_left = 0;

int count_statement(unsigned, void*, void*, void*) {
  if (--statements_left <= 0) raise(SIGKILL);
  return 0;
}

/// Every connection of this process counts its statements, triggers and R*Tree work included.
int watch_connection(sqlite3* database, const char**, const sqlite3_api_routines*) {
  return sqlite3_trace_v2(database, SQLITE_TRACE_STMT | SQLITE_TRACE_PROFILE, count_statement, nullptr);
}

std::string freeze(const StoredDraft& stored) { return stored.draft + " frozen"; }

/// Records, hands over and acknowledges until it is killed; tells each number that is durable.
[[noreturn]] void work(const StoreParams& params, int told) {
  sqlite3_auto_extension(reinterpret_cast<void (*)()>(watch_connection));
  EventStore store(params, uuid(900));
  for (;;) {
    const std::uint64_t n = store.last() + 1;
    store.record(change(n), "d" + std::to_string(n));
    if (write(told, &n, sizeof n) != sizeof n) _exit(2);
    store.documents(store.acknowledged() + 1, 4, freeze);
    if (n % 3 == 0) store.acknowledge(n - 1);
  }
}

/// @return the last number that the child said was durable before it was killed after `statements`
std::uint64_t kill_at(const StoreParams& params, long statements) {
  int pipe_ends[2];
  EXPECT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(pipe_ends[0]);
    statements_left = statements;
    work(params, pipe_ends[1]);
  }
  close(pipe_ends[1]);
  std::uint64_t durable = 0, n = 0;
  while (read(pipe_ends[0], &n, sizeof n) == sizeof n) durable = n;
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  return durable;
}

void expect_whole(const StoreParams& params, std::uint64_t last) {
  SQLite::Database database(params.path, SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("SELECT rtreecheck('place')").getString(), "ok");
  if (last == 0) return;
  EXPECT_EQ(database.execAndGet("SELECT COUNT(*) = MAX(sequence) - MIN(sequence) + 1 FROM event").getInt(), 1);
  // Event, pallet and place are of the same transaction.
  EXPECT_EQ(static_cast<std::uint64_t>(database.execAndGet("SELECT MAX(sequence) FROM pallet").getInt64()), last);
  SQLite::Statement place(database, "SELECT COUNT(*) FROM place JOIN pallet USING(key) WHERE pallet.sequence = ?");
  place.bind(1, static_cast<std::int64_t>(last));
  ASSERT_TRUE(place.executeStep());
  EXPECT_EQ(place.getColumn(0).getInt(), last % 2 == 0 ? 1 : 0);
}

TEST(StoreKill, AtAnyStatementNothingIsLostOrHalf) {
  constexpr int kKills = 200;
  const test::TemporaryFolder folder(test::TemporaryFolder::memory());
  StoreParams params;
  params.path = folder / "wms.db";
  params.boot = "boot";
  params.ballast_bytes = 4096;
  params.history = 5;
  std::set<long> statements;
  for (int kill = 1; kill <= kKills; ++kill) {
    // Half of them into a new file: its making is a sequence of statements too.
    const bool anew = kill % 2 == 1;
    if (anew) params.path = folder / ("wms" + std::to_string(kill) + ".db");
    const std::uint64_t before = anew ? 0 : EventStore(params, uuid(901)).last();
    const long statement = 1 + kill * 7 % 211;
    EXPECT_TRUE(statements.insert(statement).second) << statement << " comes again";
    const std::uint64_t durable = std::max(before, kill_at(params, statement));
    EventStore store(params, uuid(901));
    ASSERT_GE(store.last(), durable) << "kill " << kill;
    ASSERT_LE(store.last(), durable + 1) << "kill " << kill;
    expect_whole(params, store.last());
    for (const auto& stored : store.documents(store.acknowledged() + 1, 50, freeze))
      ASSERT_EQ(stored.document, "d" + std::to_string(stored.sequence) + " frozen") << "kill " << kill;
    if (HasFailure()) FAIL() << "kill " << kill;
  }
}

}  // namespace
}  // namespace lodestar
