#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/wms/clock.hpp"
#include "lodestar/wms/heard_event.hpp"

namespace lodestar {

struct StoreParams {
  std::string path;                              ///< of the file; its journal and ballast lie beside it
  std::string boot;                              ///< names the running system since its start: one monotonic clock
  std::int64_t max_pages = 16384;                ///< of 4096 octets, that new events may fill
  std::int64_t reserve_pages = 256;              ///< above max_pages, for emptying the queue alone
  std::int64_t ballast_bytes = 4 * 1024 * 1024;  ///< of the disk, for emptying the queue alone
  std::uint64_t history = 1000;                  ///< acknowledged documents that are kept for corrections
};

/// The file is damaged: open_store() sets it aside.
struct StoreCorrupt : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class Recorded {
  kNew,    ///< durable
  kKnown,  ///< it, or a later one of the tracker's life, was recorded before
  kFull,   ///< no room, nothing was changed
};

/// What the queue hands over.
struct StoredDocument {
  std::uint64_t sequence = 0;
  std::string document;
};

/// What it is made of when it is handed over for the first time.
struct StoredDraft {
  std::uint64_t sequence = 0;
  std::string draft;
  WallClock clock;
  std::vector<std::string> told;  ///< of a correction: the documents about its pallet that are known, oldest first
};

/// A pallet on the site as the last event left it.
struct StoredPallet {
  std::string id, sscc, zone;
  PalletState state = PalletState::kStanding;
  int level = 0;
  std::uint64_t sequence = 0;  ///< of that event
};

/// Axis-parallel, in map.
struct MapBox {
  Eigen::Vector3d low_m, high_m;
};

/// The events of this truck in an SQLite file that neither a kill nor a fall of power harms: write-ahead log, fsync
/// with each commit. An event, the state of its pallet and its place (R*Tree) are one transaction. Events are numbered
/// from 1 without gaps; the numbers belong to `stream()`, which a new file gets anew. What the tracker tells comes in
/// the order of its numbers: one of its lives is known up to the last of them, for ever. An event that is not
/// acknowledged is never deleted. A call that throws, or says that there is no room, has changed nothing.
class EventStore {
 public:
  /// Makes the final document of a draft.
  using Freeze = std::function<std::string(const StoredDraft&)>;

  /// Throws StoreCorrupt, or SQLite::Exception where the file cannot be used for another reason, such as that a newer
  /// version of this program wrote it. @param new_stream UUID for the numbers of a new file
  EventStore(const StoreParams& params, const std::string& new_stream);
  ~EventStore();

  const std::string& stream() const { return stream_; }
  std::uint64_t last() const { return last_; }                  ///< sequence number of the newest event; 0: none
  std::uint64_t acknowledged() const { return acknowledged_; }  ///< the site has all up to here
  std::uint64_t handed_over() const;                            ///< the newest number that documents() ever gave
  const HeardEvent& last_heard() const { return last_heard_; }  ///< the newest event
  bool full() const { return full_; }                           ///< new events find no room

  Recorded record(const PalletChange& change, const std::string& draft, const WallClock& clock = {});

  /// Documents from sequence number `first` on. One that is handed over for the first time is frozen before: durable,
  /// and the same octets ever after. Where there is no room to freeze them all, history goes; where that is not enough,
  /// those that are frozen come, and as many more as find room.
  std::vector<StoredDocument> documents(std::uint64_t first, std::size_t most, const Freeze& freeze);

  /// The site has all up to `sequence`; numbers that are not ahead of acknowledged(), or beyond last(), change nothing.
  /// @return false: not even the reserve had room
  bool acknowledge(std::uint64_t sequence);

  /// The wall clock was set by `step`, and is `offset` ahead of the monotonic one now: what this boot recorded and
  /// nobody has yet been handed bears the mark. It takes up no page of the file. Where it cannot be written all the
  /// same, as on a disk without a free block, it is not forgotten while this lives: documents() counts it in, and
  /// record() takes nothing before it is durable. @return false: there was no room
  bool mark_clock_step(Duration step, Duration offset);
  /// Tries again to write what mark_clock_step() could not.
  bool keep_clock();
  /// Wall minus monotonic clock as last kept for this boot.
  std::optional<Duration> clock_offset() const { return clock_offset_; }

  std::vector<StoredPallet> pallets_in(const MapBox& box);

 private:
  struct Sql;
  void load(const std::string& new_stream);
  Recorded insert(const PalletChange& change, const std::string& draft, const WallClock& clock);
  void put_pallet(const PalletChange& change);
  void forget_pallet(const std::string& id);
  bool forget_history();
  template <class Job>
  bool run(Job job);
  template <class Job>
  bool run_with_reserve(Job job);

  StoreParams params_;
  std::unique_ptr<Sql> sql_;
  std::string stream_;
  std::uint64_t last_ = 0, acknowledged_ = 0;
  HeardEvent last_heard_;
  bool full_ = false;
  std::optional<Duration> clock_offset_;
  Duration clock_step_{};      ///< all steps of this boot together
  bool clock_is_kept_ = true;  ///< the file has them both
};

/// A store, and what had to be done to get it.
struct OpenedStore {
  std::unique_ptr<EventStore> store;
  std::string set_aside;  ///< where a damaged file now lies; empty: there was none
  std::string damage;     ///< what was wrong with it
};

/// Opens the store; a damaged file is moved to `<path>.corrupt-<n>`, and a new one begins.
/// @param damage what was found while the file was in use: it is not opened again, whatever the checks say of it
OpenedStore open_store(const StoreParams& params, const std::string& new_stream, const std::string& damage = "");

}  // namespace lodestar
