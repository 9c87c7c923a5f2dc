#include "lodestar/wms/event_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "support/pallet_changes.hpp"
#include "support/rtree_damage.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::change;
using test::uuid;

const std::string kStream = uuid(900);

class Store : public testing::Test {
 protected:
  StoreParams params() const {
    StoreParams params;
    params.path = folder_ / "wms.db";
    params.boot = "boot-1";
    params.ballast_bytes = 65536;
    return params;
  }
  static std::string freeze(const StoredDraft& stored) {
    std::string out = std::to_string(stored.sequence) + ":" + stored.draft;
    if (stored.clock.step != Duration::zero()) out += " stepped";
    if (!stored.clock.synchronised) out += " unsynchronised";
    for (const std::string& told : stored.told) out += " after " + told;
    return out;
  }

  test::TemporaryFolder folder_{test::TemporaryFolder::memory()};
};

TEST_F(Store, NumbersFromOneAndKeepsEverythingOverARestart) {
  {
    EventStore store(params(), kStream);
    EXPECT_EQ(store.last(), 0u);
    EXPECT_EQ(store.acknowledged(), 0u);
    for (int n = 1; n <= 6; ++n) EXPECT_EQ(store.record(change(n), "d" + std::to_string(n)), Recorded::kNew);
    EXPECT_TRUE(store.acknowledge(2));
  }
  EventStore store(params(), uuid(901));
  EXPECT_EQ(store.stream(), kStream);
  EXPECT_EQ(store.last(), 6u);
  EXPECT_EQ(store.last_heard(), heard_event(change(6)));
  EXPECT_EQ(store.acknowledged(), 2u);
  const auto documents = store.documents(3, 3, freeze);
  ASSERT_EQ(documents.size(), 3u);
  EXPECT_EQ(documents[0].sequence, 3u);
  EXPECT_EQ(documents[0].document, "3:d3");
}

TEST_F(Store, KnowsHowFarItHandedOver) {
  {
    EventStore store(params(), kStream);
    for (int n = 1; n <= 9; ++n) store.record(change(n), "d");
    EXPECT_EQ(store.handed_over(), 0u);
    store.documents(1, 6, freeze);
    EXPECT_EQ(store.handed_over(), 6u);
  }
  EventStore store(params(), uuid(901));
  EXPECT_EQ(store.handed_over(), 6u);
  store.documents(4, 2, freeze);
  EXPECT_EQ(store.handed_over(), 6u);
}

TEST_F(Store, TheSameEventIsRecordedOnce) {
  EventStore store(params(), kStream);
  EXPECT_EQ(store.record(change(1), "d"), Recorded::kNew);
  EXPECT_EQ(store.record(change(1), "d"), Recorded::kKnown);
  EXPECT_EQ(store.last(), 1u);
  // A tracker that began anew uses the number again, in another life.
  PalletChange again = change(1);
  again.life = uuid(701);
  EXPECT_EQ(store.record(again, "d"), Recorded::kNew);
  EXPECT_EQ(store.last(), 2u);
}

TEST_F(Store, DocumentsAreFrozenOnce) {
  int frozen = 0;
  const auto count = [&](const StoredDraft& stored) { return stored.draft + " frozen " + std::to_string(++frozen); };
  std::string first;
  {
    EventStore store(params(), kStream);
    store.record(change(1), "d1");
    first = store.documents(1, 50, count)[0].document;
    EXPECT_EQ(store.documents(1, 50, count)[0].document, first);
    store.record(change(2), "d2");
  }
  EventStore store(params(), kStream);
  EXPECT_EQ(store.documents(1, 50, count)[0].document, first);
  EXPECT_EQ(frozen, 2);
}

TEST_F(Store, AnEventWhoseDocumentIsForgottenIsStillKnown) {
  StoreParams short_history = params();
  short_history.history = 1;
  EventStore store(short_history, kStream);
  for (int n = 1; n <= 9; ++n) store.record(change(n), "d");
  ASSERT_TRUE(store.acknowledge(9));
  EXPECT_EQ(store.documents(1, 9, freeze).size(), 1u) << "of history";
  for (int n = 1; n <= 9; ++n) EXPECT_EQ(store.record(change(n), "d"), Recorded::kKnown) << n;
  EXPECT_EQ(store.last(), 9u);
}

TEST_F(Store, AFileWithoutAnyEventStillKnowsThemAll) {
  {
    EventStore store(params(), kStream);
    for (int n = 1; n <= 9; ++n) store.record(change(n), "d");
    ASSERT_TRUE(store.acknowledge(9));
  }
  SQLite::Database(params().path, SQLite::OPEN_READWRITE).exec("DELETE FROM event");
  EventStore store(params(), kStream);
  EXPECT_EQ(store.last(), 9u);
  EXPECT_EQ(store.last_heard(), heard_event(change(9)));
  EXPECT_EQ(store.record(change(9), "d"), Recorded::kKnown);
  EXPECT_EQ(store.record(change(10), "d"), Recorded::kNew);
}

TEST_F(Store, OldEventsGoAndAreStillKnown) {
  StoreParams short_history = params();
  short_history.history = 1;
  EventStore store(short_history, kStream);
  const auto rows = [&] {
    return SQLite::Database(short_history.path).execAndGet("SELECT COUNT(*) FROM event").getInt();
  };
  for (int n = 1; n <= 2500; ++n) {
    store.record(change(n), "d");
    if (n % 50 == 0) store.acknowledge(n);
  }
  EXPECT_EQ(rows(), 1);
  for (const int n : {1, 499, 500, 2500}) EXPECT_EQ(store.record(change(n), "d"), Recorded::kKnown) << n;
}

TEST_F(Store, ACorrectionFindsWhatWasToldOfItsPallets) {
  EventStore store(params(), kStream);
  // Pallet 1 is lifted and set down, then pallet 2, which proves to be pallet 7; pallet 3 has nothing to do with it.
  for (const int n : {1, 2, 3, 4, 5}) store.record(change(n), "d" + std::to_string(n));
  PalletChange correction = change(3);
  correction.kind = PalletChangeKind::kCorrection;
  correction.pallet.id = uuid(7);
  correction.sequence = 6;
  correction.corrects = 4;
  store.record(correction, "d6");
  EXPECT_EQ(store.documents(1, 50, freeze)[5].document, "6:d6 after 3:d3 after 4:d4");
  correction.sequence = 7;
  correction.corrects = 77;
  store.record(correction, "d7");
  EXPECT_EQ(store.documents(7, 50, freeze)[0].document, "7:d7 after 6:d6 after 3:d3 after 4:d4");
}

TEST_F(Store, AcknowledgementsOnlyGoForward) {
  StoreParams short_history = params();
  short_history.history = 1;
  EventStore store(short_history, kStream);
  for (int n = 1; n <= 5; ++n) store.record(change(n), "d");
  store.acknowledge(3);
  EXPECT_EQ(store.acknowledged(), 3u);
  store.acknowledge(2);
  store.acknowledge(0);
  EXPECT_EQ(store.acknowledged(), 3u);
  store.acknowledge(9);
  EXPECT_EQ(store.acknowledged(), 3u);
  EXPECT_EQ(store.documents(1, 50, freeze).front().sequence, 3u);
}

TEST_F(Store, PalletsAndTheirPlaces) {
  EventStore store(params(), kStream);
  for (int n = 1; n <= 40; ++n) store.record(change(n), "d");
  // Drop 2 set pallet 1 down at x = 0.5, drop 4 pallet 2 at 1.0, ...
  auto found = store.pallets_in({{0.4, 0, 0}, {1.1, 9, 9}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].id, uuid(1));
  EXPECT_EQ(found[0].zone, "A-1");
  EXPECT_EQ(found[0].sequence, 2u);
  // Picked up again it stands nowhere.
  store.record(change(41), "d");
  found = store.pallets_in({{0.4, 0, 0}, {1.1, 9, 9}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, uuid(2));
  // Gone it is forgotten, and set down anew where it stands now.
  PalletChange gone = change(4);
  gone.sequence = 42;
  gone.pallet.state = PalletState::kGone;
  store.record(gone, "d");
  EXPECT_TRUE(store.pallets_in({{0.4, 0, 0}, {1.1, 9, 9}}).empty());
  PalletChange back = change(4);
  back.sequence = 43;
  store.record(back, "d");
  EXPECT_EQ(store.pallets_in({{0.4, 0, 0}, {1.1, 9, 9}}).size(), 1u);
  back.sequence = 44;
  back.pallet.T_map_pallet.translation().x() = 7;
  store.record(back, "d");
  EXPECT_TRUE(store.pallets_in({{0.4, 0, 0}, {1.1, 9, 9}}).empty());
}

TEST_F(Store, AFullFileKeepsAllAndIsWorkedOff) {
  StoreParams small = params();
  small.max_pages = 60;
  small.reserve_pages = 16;
  small.history = 1;
  EventStore store(small, kStream);
  const std::string draft(2000, 'd');
  std::uint64_t n = 1;
  while (store.record(change(n), draft) == Recorded::kNew) ++n;
  EXPECT_TRUE(store.full());
  const std::uint64_t held = n - 1;
  EXPECT_GT(held, 20u);
  EXPECT_EQ(store.last(), held);
  EXPECT_EQ(store.record(change(n), draft), Recorded::kFull);

  std::uint64_t next = 1;
  while (next <= held) {
    const auto documents = store.documents(next, 50, freeze);
    ASSERT_FALSE(documents.empty()) << "at " << next;
    for (const auto& document : documents) EXPECT_EQ(document.sequence, next++);
    ASSERT_TRUE(store.acknowledge(next - 1));
  }
  EXPECT_EQ(store.record(change(n), draft), Recorded::kNew);
  EXPECT_FALSE(store.full());
  EXPECT_EQ(store.last(), held + 1);
}

TEST_F(Store, DocumentsThatAreLargeBesideTheReserveAreWorkedOffAFewAtATime) {
  StoreParams small = params();
  small.max_pages = 120;
  small.reserve_pages = 64;
  EventStore store(small, kStream);
  std::uint64_t held = 0;
  while (store.record(change(held + 1), std::string(500, 'd')) == Recorded::kNew) ++held;
  const auto large = [](const StoredDraft& stored) { return stored.draft + std::string(60000, 'f'); };
  std::uint64_t next = 1;
  while (next <= held) {
    const auto documents = store.documents(next, 50, large);
    ASSERT_FALSE(documents.empty()) << "at " << next << " of " << held;
    const auto again = store.documents(next, 50, large);
    ASSERT_GE(again.size(), documents.size()) << "what is frozen goes out always";
    for (std::size_t i = 0; i < again.size(); ++i) ASSERT_EQ(again[i].sequence, next + i);
    for (const auto& document : again) ASSERT_EQ(document.document, std::string(500, 'd') + std::string(60000, 'f'));
    next += again.size();
    ASSERT_TRUE(store.acknowledge(next - 1));
  }
  EXPECT_GT(held, 50u);
  EXPECT_EQ(store.record(change(held + 1), "d"), Recorded::kNew);
}

TEST_F(Store, AFullFileKnowsWhatItHeardLast) {
  StoreParams small = params();
  small.max_pages = 60;
  small.reserve_pages = 16;
  {
    EventStore store(small, kStream);
    for (int n = 1; n <= 9; ++n) store.record(change(n), "d");
    ASSERT_TRUE(store.acknowledge(9));
    EXPECT_EQ(store.record(change(10), std::string(1000000, 'd')), Recorded::kFull);
  }
  EventStore store(small, kStream);
  EXPECT_EQ(store.last_heard(), heard_event(change(9)));
  EXPECT_EQ(store.record(change(9), "d"), Recorded::kKnown);
  EXPECT_TRUE(store.documents(1, 9, freeze).empty()) << "history went";
}

TEST_F(Store, TheReserveIsKeptBackAgainWhateverFails) {
  StoreParams small = params();
  small.max_pages = 60;
  small.reserve_pages = 16;
  EventStore store(small, kStream);
  std::uint64_t n = 1;
  store.record(change(n++), "d");
  const auto fail = [](const StoredDraft&) -> std::string { throw std::runtime_error("no document"); };
  EXPECT_THROW(store.documents(1, 1, fail), std::runtime_error);
  while (store.record(change(n), std::string(2000, 'd')) == Recorded::kNew) ++n;
  EXPECT_LE(SQLite::Database(small.path).execAndGet("PRAGMA page_count").getInt(), small.max_pages);
}

TEST_F(Store, AFullDiskIsWorkedOffFromTheBallast) {
  const std::string disk = folder_ / "disk";
  std::filesystem::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=3m") != 0)
    GTEST_SKIP() << "no right to mount a small disk: " << std::strerror(errno);
  {
    StoreParams on_disk = params();
    on_disk.path = disk + "/wms.db";
    on_disk.ballast_bytes = 1 << 20;
    on_disk.history = 1;
    EventStore store(on_disk, kStream);
    const std::string draft(4000, 'd');
    std::uint64_t n = 1;
    while (n < 20 && store.record(change(n), draft) == Recorded::kNew) ++n;
    // Somebody else fills the disk.
    std::ofstream filler(disk + "/filler");
    while (filler << std::string(4096, 'f') << std::flush) {
    }
    while (n < 2000 && store.record(change(n), draft) == Recorded::kNew) ++n;
    EXPECT_TRUE(store.full());
    const std::uint64_t held = store.last();
    std::uint64_t next = 1;
    while (next <= held) {
      const auto documents = store.documents(next, 5, freeze);
      ASSERT_FALSE(documents.empty()) << "at " << next << " of " << held;
      for (const auto& document : documents) EXPECT_EQ(document.sequence, next++);
      ASSERT_TRUE(store.acknowledge(next - 1)) << "at " << next << " of " << held;
    }
    EXPECT_EQ(store.record(change(n), draft), Recorded::kFull) << "the ballast is for emptying the queue alone";
    std::filesystem::remove(disk + "/filler");
    filler.close();
    EXPECT_EQ(store.record(change(n), draft), Recorded::kNew);
    EXPECT_EQ(store.last(), held + 1);
  }
  umount(disk.c_str());
}

TEST_F(Store, AClockThatIsSetMarksWhatNobodyWasHanded) {
  {
    EventStore store(params(), kStream);
    EXPECT_FALSE(store.clock_offset());
    store.mark_clock_step(Duration::zero(), from_seconds(5));
    store.record(change(1), "d1");
    store.record(change(2), "d2");
    store.documents(1, 1, freeze);
    EXPECT_TRUE(store.mark_clock_step(from_seconds(3600), from_seconds(3605)));
    store.record(change(3), "d3");
    const auto documents = store.documents(1, 50, freeze);
    EXPECT_EQ(documents[0].document, "1:d1");
    EXPECT_EQ(documents[1].document, "2:d2 stepped");
    EXPECT_EQ(documents[2].document, "3:d3");
    store.record(change(4), "d4");
    EXPECT_EQ(store.clock_offset(), from_seconds(3605));
  }
  StoreParams rebooted = params();
  rebooted.boot = "boot-2";
  EventStore store(rebooted, kStream);
  EXPECT_FALSE(store.clock_offset());
  EXPECT_TRUE(store.mark_clock_step(from_seconds(3600), from_seconds(3600)));
  EXPECT_EQ(store.documents(4, 1, freeze)[0].document, "4:d4");
}

TEST_F(Store, WhatWasHeardWhileNobodyKeptTheClockBearsTheMark) {
  EventStore store(params(), kStream);
  store.record(change(1), "d1", {false, Duration::zero()});
  store.record(change(2), "d2");
  const auto documents = store.documents(1, 50, freeze);
  EXPECT_EQ(documents[0].document, "1:d1 unsynchronised");
  EXPECT_EQ(documents[1].document, "2:d2");
}

TEST_F(Store, AFullStoreKeepsAClockStepOverAReboot) {
  StoreParams small = params();
  small.max_pages = 60;
  small.reserve_pages = 1;
  {
    EventStore store(small, kStream);
    store.mark_clock_step(Duration::zero(), from_seconds(5));
    std::uint64_t n = 0;
    while (store.record(change(n + 1), std::string(100, 'd')) == Recorded::kNew) ++n;
    // Nor is anything of the reserve left.
    const auto longer = [](const StoredDraft& stored) { return stored.draft + std::string(3000, 'f'); };
    ASSERT_LT(store.documents(1, 50, longer).size(), 50u);
    ASSERT_GT(n, 50u);
    EXPECT_TRUE(store.mark_clock_step(from_seconds(3600), from_seconds(3605)));
  }
  small.boot = "boot-2";
  small.reserve_pages = 1000;
  EventStore store(small, kStream);
  const auto documents = store.documents(store.last(), 1, freeze);
  ASSERT_EQ(documents.size(), 1u);
  EXPECT_NE(documents[0].document.find(" stepped"), std::string::npos);
}

TEST_F(Store, AClockStepThatCannotBeWrittenIsNotForgotten) {
  const auto step = from_seconds(3600), offset = from_seconds(3605);
  EventStore store(params(), kStream);
  for (int n = 1; n <= 2; ++n) store.record(change(n), "d" + std::to_string(n));
  SQLite::Database other(params().path, SQLite::OPEN_READWRITE);
  {
    SQLite::Transaction busy(other, SQLite::TransactionBehavior::IMMEDIATE);
    EXPECT_THROW(store.mark_clock_step(step, offset), SQLite::Exception);
    EXPECT_THROW(store.record(change(3), "d3"), SQLite::Exception);
  }
  // What is handed over meanwhile bears the mark already.
  EXPECT_EQ(store.documents(1, 1, freeze)[0].document, "1:d1 stepped");
  EXPECT_EQ(store.record(change(3), "d3"), Recorded::kNew);
  EXPECT_EQ(store.clock_offset(), offset);
  const auto documents = store.documents(1, 50, freeze);
  ASSERT_EQ(documents.size(), 3u);
  EXPECT_EQ(documents[0].document, "1:d1 stepped");
  EXPECT_EQ(documents[1].document, "2:d2 stepped");
  EXPECT_EQ(documents[2].document, "3:d3");
}

TEST_F(Store, ADamagedFileIsSetAsideAndANewOneBegins) {
  std::ofstream(params().path) << std::string(20000, 'x');
  auto opened = open_store(params(), kStream);
  EXPECT_EQ(opened.set_aside, params().path + ".corrupt-1");
  EXPECT_NE(opened.damage, "");
  EXPECT_TRUE(std::filesystem::exists(opened.set_aside));
  EXPECT_EQ(opened.store->record(change(1), "d"), Recorded::kNew);
  opened.store.reset();

  // The pages of a store that were overwritten in the middle; its log is gone.
  for (int n = 0; n < 3; ++n) {
    EventStore store(params(), kStream);
    store.record(change(10 + n), std::string(30000, 'd'));
  }
  {
    std::fstream file(params().path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(8192);
    file << std::string(40000, '\xff');
  }
  opened = open_store(params(), uuid(902));
  EXPECT_EQ(opened.set_aside, params().path + ".corrupt-2");
  EXPECT_EQ(opened.store->stream(), uuid(902));
  EXPECT_EQ(opened.store->last(), 0u);
}

TEST_F(Store, ADamagedRTreeIsDamage) {
  {
    EventStore store(params(), kStream);
    for (int n = 1; n <= 4; ++n) store.record(change(n), "d");
  }
  test::damage_rtree(params().path);
  const OpenedStore opened = open_store(params(), uuid(901));
  EXPECT_EQ(opened.set_aside, params().path + ".corrupt-1");
  EXPECT_NE(opened.damage, "");
  EXPECT_EQ(opened.store->record(change(5), "d"), Recorded::kNew);
}

TEST_F(Store, DamageThatNoCheckSeesSetsTheFileAsideAllTheSame) {
  EventStore(params(), kStream).record(change(1), "d");
  const OpenedStore opened = open_store(params(), uuid(901), "found while it ran");
  EXPECT_EQ(opened.set_aside, params().path + ".corrupt-1");
  EXPECT_EQ(opened.damage, "found while it ran");
  EXPECT_EQ(opened.store->stream(), uuid(901));
  EXPECT_EQ(opened.store->last(), 0u);
}

/// Makes the tables of a file those of version 3, which knew each event by a row of its own.
const char kAsVersionThree[] =
    R"(DROP TABLE life;
       DROP INDEX event_pallet;
       ALTER TABLE event RENAME TO new_event;
       CREATE TABLE event(
         sequence INTEGER PRIMARY KEY, heard INTEGER NOT NULL, stamp_ns INTEGER NOT NULL, pallet TEXT NOT NULL,
         corrects INTEGER NOT NULL, document TEXT NOT NULL, frozen INTEGER NOT NULL DEFAULT 0,
         boot TEXT NOT NULL DEFAULT '', clock_step_ns INTEGER NOT NULL DEFAULT 0,
         synchronised INTEGER NOT NULL DEFAULT 1, UNIQUE(heard, stamp_ns, pallet));
       INSERT INTO event SELECT sequence, heard, sequence, pallet, corrects, document, frozen, boot, clock_step_ns,
         synchronised FROM new_event;
       DROP TABLE new_event;
       CREATE INDEX event_pallet ON event(pallet);
       PRAGMA user_version = 3;)";

TEST_F(Store, AnOlderFileIsBroughtUpANewerOneIsLeftAlone) {
  {
    EventStore store(params(), kStream);
    store.record(change(1), "d1");
  }
  {
    // As version 1 left it.
    SQLite::Database old(params().path, SQLite::OPEN_READWRITE);
    old.exec(kAsVersionThree);
    old.exec("DROP INDEX event_pallet");
    old.exec("DROP TABLE clock");
    old.exec("ALTER TABLE event DROP COLUMN synchronised");
    old.exec("ALTER TABLE event DROP COLUMN boot");
    old.exec("ALTER TABLE event DROP COLUMN clock_step_ns");
    old.exec("PRAGMA user_version = 1");
  }
  {
    EventStore store(params(), kStream);
    EXPECT_EQ(store.documents(1, 50, freeze)[0].document, "1:d1");
    EXPECT_EQ(store.record(change(2), "d2"), Recorded::kNew);
  }
  SQLite::Database(params().path, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_THROW(open_store(params(), kStream), SQLite::Exception);
  EXPECT_FALSE(std::filesystem::exists(params().path + ".corrupt-1"));
}

TEST_F(Store, AQueueOfVersionTwoIsGoneOnWith) {
  {
    EventStore store(params(), kStream);
    for (int n = 1; n <= 6; ++n) store.record(change(n), "d" + std::to_string(n));
    store.documents(1, 4, freeze);
    ASSERT_TRUE(store.acknowledge(3));
  }
  {
    // As version 2 left it, which kept an event's own step of the clock alone.
    SQLite::Database old(params().path, SQLite::OPEN_READWRITE);
    old.exec(kAsVersionThree);
    old.exec("DROP INDEX event_pallet");
    old.exec("DROP TABLE clock");
    old.exec("ALTER TABLE event DROP COLUMN synchronised");
    old.exec("UPDATE event SET clock_step_ns = 3600000000000 WHERE sequence = 5");
    old.exec("PRAGMA user_version = 2");
  }
  EventStore store(params(), uuid(901));
  EXPECT_EQ(store.stream(), kStream);
  EXPECT_EQ(store.acknowledged(), 3u);
  EXPECT_EQ(store.last_heard(), HeardEvent()) << "events had no life then";
  const auto again = [](const StoredDraft& stored) { return freeze(stored) + " now"; };
  std::vector<std::string> documents;
  for (const auto& stored : store.documents(1, 50, again)) documents.push_back(stored.document);
  EXPECT_EQ(documents, (std::vector<std::string>{"1:d1", "2:d2", "3:d3", "4:d4", "5:d5 stepped now", "6:d6 now"}));
  const auto found = store.pallets_in({{0.4, 0, 0}, {1.6, 9, 9}});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[2].zone, "A-3");
  EXPECT_EQ(store.record(change(7), "d"), Recorded::kNew);
  EXPECT_EQ(store.last(), 7u);
}

TEST_F(Store, TextStaysText) {
  EventStore store(params(), kStream);
  PalletChange odd = change(2);
  odd.pallet.zone = "'); DROP TABLE event; --";
  odd.pallet.id = std::string(10240, 'i');
  EXPECT_EQ(store.record(odd, "<script>alert(1)</script>"), Recorded::kNew);
  EXPECT_EQ(store.documents(1, 1, freeze)[0].document, "1:<script>alert(1)</script>");
  const auto found = store.pallets_in({{-99, -99, -99}, {99, 99, 99}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].zone, odd.pallet.zone);
  EXPECT_EQ(found[0].id, odd.pallet.id);
}

}  // namespace
}  // namespace lodestar
