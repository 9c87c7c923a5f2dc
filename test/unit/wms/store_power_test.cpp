// The power falls while the store works: what was written and not synced is lost sector by sector or not, as chance has
// it. What the store had promised must hold when it is opened again: every event that it called durable, every document
// that it handed over octet by octet, and the site's acknowledgements.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "lodestar/wms/event_store.hpp"
#include "support/falling_power.hpp"
#include "support/pallet_changes.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::change;
using test::uuid;

/// What calls of the store that returned said.
struct Promise {
  std::string stream;
  std::uint64_t last = 0, acknowledged = 0;
  std::map<std::uint64_t, std::string> drafts, documents;
};

EventStore::Freeze freeze_in(int life) {
  return [life](const StoredDraft& stored) { return stored.draft + " frozen in life " + std::to_string(life); };
}

/// Records, hands over and acknowledges until the power falls. The log is moved into the file much more often than by
/// itself, which would be once in a thousand pages.
void work(const StoreParams& params, int life, Promise& promise) {
  EventStore store(params, uuid(1000 + life));
  SQLite::Database mover(params.path, SQLite::OPEN_READWRITE);
  promise.stream = store.stream();
  for (;;) {
    const std::uint64_t n = store.last() + 1;
    const std::string draft = std::to_string(life) + " " + std::string(n % 4 == 0 ? 20000 : 500, 'd');
    if (store.record(change(n), draft) != Recorded::kNew) throw std::logic_error("not recorded");
    promise.last = n;
    promise.drafts[n] = draft;
    for (const StoredDocument& stored : store.documents(store.acknowledged() + 1, 4, freeze_in(life)))
      promise.documents[stored.sequence] = stored.document;
    if (n % 3 == 0 && store.acknowledge(n - 1)) promise.acknowledged = n - 1;
    if (n % 4 == 2) mover.exec("PRAGMA wal_checkpoint(PASSIVE)");
  }
}

void expect_kept(const StoreParams& params, int life, Promise& promise) {
  EventStore store(params, uuid(2000 + life));
  EXPECT_TRUE(promise.stream.empty() || store.stream() == promise.stream) << "its numbers would be used again";
  ASSERT_GE(store.last(), promise.last);
  ASSERT_LE(store.last(), promise.last + 1) << "the one that was under way may be there too";
  promise.last = store.last();
  EXPECT_GE(store.acknowledged(), promise.acknowledged);
  for (const StoredDocument& stored : store.documents(store.acknowledged() + 1, 100, freeze_in(life))) {
    const auto document = promise.documents.find(stored.sequence);
    const auto draft = promise.drafts.find(stored.sequence);
    if (document != promise.documents.end()) {
      EXPECT_TRUE(stored.document == document->second) << stored.sequence << " was handed over as another";
    } else if (draft != promise.drafts.end()) {
      EXPECT_EQ(stored.document.compare(0, draft->second.size(), draft->second), 0) << stored.sequence;
    }
    promise.documents[stored.sequence] = stored.document;
  }
  SQLite::Database database(params.path, SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("SELECT rtreecheck('place')").getString(), "ok");
}

TEST(StorePower, WhateverWasPromisedOutlivesAFall) {
  constexpr int kFalls = 400;
  const test::TemporaryFolder folder(test::TemporaryFolder::memory());
  std::mt19937 random(1);
  test::FallingPower power;
  StoreParams params;
  params.boot = "boot";
  params.ballast_bytes = 4096;
  params.history = 5;
  Promise promise;
  int in_log = 0, in_file = 0, afterwards = 0;
  for (int life = 1; life <= kFalls; ++life) {
    // A third of them as a new file is made; the others in what earlier falls left.
    if (life % 3 == 1) {
      params.path = folder / ("wms" + std::to_string(life) + ".db");
      promise = Promise();
    }
    power.fall_at(1 + static_cast<long>(random() % (life % 3 == 1 ? 120 : 500)));
    EXPECT_THROW(work(params, life, promise), std::exception);
    ASSERT_TRUE(power.fallen()) << "life " << life;
    in_log += power.unsynced("-wal") ? 1 : 0;
    in_file += power.unsynced(".db") ? 1 : 0;
    afterwards += promise.documents.empty() ? 0 : 1;
    power.leave_what_survived(random);
    expect_kept(params, life, promise);
    if (HasFailure()) FAIL() << "life " << life;
  }
  EXPECT_GT(in_log, kFalls / 4);
  EXPECT_GT(in_file, kFalls / 20) << "while the log is moved into the file";
  EXPECT_GT(afterwards, kFalls / 2);
}

}  // namespace
}  // namespace lodestar
