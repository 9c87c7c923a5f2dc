#pragma once

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace lodestar::test {

/// SQLite's files on a disk whose power falls: a VFS in front of the usual one that knows of each file what was synced.
/// Of the rest every sector of every write reached the disk or did not, as chance has it, and so did every name that
/// was made or taken away since the folder was synced.
class FallingPower {
 public:
  /// From now on every connection of this process goes through it.
  FallingPower() {
    vfs_.iVersion = 1;
    vfs_.szOsFile = static_cast<int>(sizeof(File)) + usual_->szOsFile;
    vfs_.mxPathname = usual_->mxPathname;
    vfs_.zName = "falling power";
    vfs_.pAppData = this;
    vfs_.xOpen = open;
    vfs_.xDelete = remove;
    vfs_.xAccess = [](sqlite3_vfs* v, const char* p, int f, int* r) { return usual(v)->xAccess(usual(v), p, f, r); };
    vfs_.xFullPathname = [](sqlite3_vfs* v, const char* p, int n, char* r) {
      return usual(v)->xFullPathname(usual(v), p, n, r);
    };
    vfs_.xRandomness = [](sqlite3_vfs* v, int n, char* r) { return usual(v)->xRandomness(usual(v), n, r); };
    vfs_.xSleep = [](sqlite3_vfs* v, int us) { return usual(v)->xSleep(usual(v), us); };
    vfs_.xCurrentTime = [](sqlite3_vfs* v, double* t) { return usual(v)->xCurrentTime(usual(v), t); };
    vfs_.xGetLastError = [](sqlite3_vfs*, int, char*) { return 0; };
    if (sqlite3_vfs_register(&vfs_, 1) != SQLITE_OK) throw std::runtime_error("no VFS");
  }
  ~FallingPower() { sqlite3_vfs_unregister(&vfs_); }
  FallingPower(const FallingPower&) = delete;
  FallingPower& operator=(const FallingPower&) = delete;

  /// What lies there now is on the disk; the power falls as the so manieth change of a file is asked for.
  void fall_at(long change) {
    disk_.clear();
    changes_left_ = change;
  }
  bool fallen() const { return changes_left_ <= 0; }
  /// Whether a file whose name ends so holds what was not synced.
  bool unsynced(const std::string& end_of_name) const {
    return std::any_of(disk_.begin(), disk_.end(), [&](const auto& file) {
      const std::string& path = file.first;
      return !file.second.pending.empty() && path.size() >= end_of_name.size() &&
             path.compare(path.size() - end_of_name.size(), std::string::npos, end_of_name) == 0;
    });
  }

  /// The power is back; every connection has been closed.
  template <class Random>
  void leave_what_survived(Random& random) {
    const auto chance = [&] { return random() % 2 == 0; };
    for (const auto& [path, file] : disk_) {
      const bool present = file.present == file.present_on_disk ? file.present : chance();
      std::filesystem::remove(path + "-shm");
      std::filesystem::remove(path);
      if (!present) continue;
      std::string octets = file.on_disk;
      for (const Change& change : file.pending) survive(change, chance, octets);
      std::ofstream(path, std::ios::binary) << octets;
    }
    disk_.clear();
    changes_left_ = kNever;
  }

 private:
  static constexpr long kNever = 1L << 60;
  static constexpr std::size_t kSector = 512;

  /// Octets from a place on; or, without any, the file ends there.
  struct Change {
    std::size_t at;
    std::string octets;
  };
  struct OnDisk {
    std::string on_disk;
    std::vector<Change> pending;
    bool present = true, present_on_disk = true;
  };
  struct File {
    sqlite3_file base;
    FallingPower* power;
    OnDisk* disk;
    bool syncs_folder;  ///< with its next sync, as the usual VFS does with a new journal
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
  };

  static FallingPower& self(sqlite3_vfs* vfs) { return *static_cast<FallingPower*>(vfs->pAppData); }
  static sqlite3_vfs* usual(sqlite3_vfs* vfs) { return self(vfs).usual_; }
  static File& file(sqlite3_file* f) { return *reinterpret_cast<File*>(f); }
  static sqlite3_file* real(sqlite3_file* f) { return file(f).real(); }
  static const sqlite3_io_methods& usual(sqlite3_file* f) { return *real(f)->pMethods; }

  /// @return whether there is power for one more change
  bool step() { return --changes_left_ > 0; }

  template <class Chance>
  static void survive(const Change& change, const Chance& chance, std::string& octets) {
    if (change.octets.empty()) {
      if (chance()) octets.resize(change.at);
      return;
    }
    for (std::size_t from = 0; from < change.octets.size();) {
      const std::size_t at = change.at + from;
      const std::size_t count = std::min(change.octets.size() - from, kSector - at % kSector);
      if (chance()) {
        octets.resize(std::max(octets.size(), at + count));
        octets.replace(at, count, change.octets, from, count);
      }
      from += count;
    }
  }

  OnDisk& found(const std::string& path) {
    const auto known = disk_.find(path);
    if (known != disk_.end()) return known->second;
    OnDisk& entry = disk_[path];
    std::ifstream stream(path, std::ios::binary);
    entry.present = entry.present_on_disk = stream.good();
    if (stream) entry.on_disk.assign(std::istreambuf_iterator<char>(stream), {});
    return entry;
  }

  static int open(sqlite3_vfs* vfs, const char* path, sqlite3_file* f, int flags, int* out_flags) {
    FallingPower& power = self(vfs);
    f->pMethods = nullptr;
    if (power.fallen() || path == nullptr) return SQLITE_CANTOPEN;
    OnDisk& entry = power.found(path);
    File& opened = *new (f) File{{}, &power, &entry, (flags & (SQLITE_OPEN_WAL | SQLITE_OPEN_MAIN_JOURNAL)) != 0};
    const int code = usual(vfs)->xOpen(usual(vfs), path, opened.real(), flags, out_flags);
    if (opened.real()->pMethods == nullptr) return code;
    entry.present = true;
    f->pMethods = methods();
    return code;
  }

  static int remove(sqlite3_vfs* vfs, const char* path, int sync_folder) {
    FallingPower& power = self(vfs);
    OnDisk& entry = power.found(path);
    if (!power.step()) return SQLITE_IOERR_DELETE;
    entry.present = false;
    if (sync_folder != 0) power.sync_folder();
    return usual(vfs)->xDelete(usual(vfs), path, sync_folder);
  }

  void sync_folder() {
    for (auto& [path, entry] : disk_) entry.present_on_disk = entry.present;
  }

  static int write(sqlite3_file* f, const void* octets, int count, sqlite3_int64 at) {
    if (!file(f).power->step()) return SQLITE_IOERR_WRITE;
    file(f).disk->pending.push_back(
        {static_cast<std::size_t>(at), std::string(static_cast<const char*>(octets), static_cast<std::size_t>(count))});
    return usual(f).xWrite(real(f), octets, count, at);
  }
  static int truncate(sqlite3_file* f, sqlite3_int64 size) {
    if (!file(f).power->step()) return SQLITE_IOERR_TRUNCATE;
    file(f).disk->pending.push_back({static_cast<std::size_t>(size), ""});
    return usual(f).xTruncate(real(f), size);
  }
  static int sync(sqlite3_file* f, int) {
    File& synced = file(f);
    if (!synced.power->step()) return SQLITE_IOERR_FSYNC;
    for (const Change& change : synced.disk->pending)
      survive(
          change, [] { return true; }, synced.disk->on_disk);
    synced.disk->pending.clear();
    if (std::exchange(synced.syncs_folder, false)) synced.power->sync_folder();
    return SQLITE_OK;
  }
  static int read(sqlite3_file* f, void* octets, int count, sqlite3_int64 at) {
    return file(f).power->fallen() ? SQLITE_IOERR_READ : usual(f).xRead(real(f), octets, count, at);
  }

  static const sqlite3_io_methods* methods() {
    using F = sqlite3_file;
    static const sqlite3_io_methods all = [] {
      sqlite3_io_methods m{};
      m.iVersion = 2;
      m.xClose = [](F* f) { return usual(f).xClose(real(f)); };
      m.xRead = read;
      m.xWrite = write;
      m.xTruncate = truncate;
      m.xSync = sync;
      m.xFileSize = [](F* f, sqlite3_int64* size) { return usual(f).xFileSize(real(f), size); };
      m.xLock = [](F* f, int level) { return usual(f).xLock(real(f), level); };
      m.xUnlock = [](F* f, int level) { return usual(f).xUnlock(real(f), level); };
      m.xCheckReservedLock = [](F* f, int* out) { return usual(f).xCheckReservedLock(real(f), out); };
      m.xFileControl = [](F* f, int op, void* argument) { return usual(f).xFileControl(real(f), op, argument); };
      m.xSectorSize = [](F* f) { return usual(f).xSectorSize(real(f)); };
      m.xDeviceCharacteristics = [](F* f) { return usual(f).xDeviceCharacteristics(real(f)); };
      m.xShmMap = [](F* f, int page, int size, int extend, void volatile** out) {
        return usual(f).xShmMap(real(f), page, size, extend, out);
      };
      m.xShmLock = [](F* f, int offset, int count, int flags) {
        return usual(f).xShmLock(real(f), offset, count, flags);
      };
      m.xShmBarrier = [](F* f) { usual(f).xShmBarrier(real(f)); };
      m.xShmUnmap = [](F* f, int remove_it) { return usual(f).xShmUnmap(real(f), remove_it); };
      return m;
    }();
    return &all;
  }

  sqlite3_vfs vfs_{};
  sqlite3_vfs* usual_ = sqlite3_vfs_find(nullptr);
  std::map<std::string, OnDisk> disk_;
  long changes_left_ = kNever;
};

}  // namespace lodestar::test
