#include "lodestar/base/common/replace_file.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "support/temporary_folder.hpp"

// What replace_file asks of the system goes through here.
namespace {

struct Request {
  enum { kWrite, kSync, kRename, kSyncFolder } what;
  std::string octets = "";
};
std::vector<Request> requests;
bool listening = false;
std::size_t most_at_once = 1 << 20;

template <class Function>
Function usual(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_folder(int file) { return std::filesystem::is_directory("/proc/self/fd/" + std::to_string(file)); }

}  // namespace

extern "C" ssize_t write(int file, const void* octets, size_t count) {
  const auto next = usual<ssize_t (*)(int, const void*, size_t)>("write");
  if (!listening) return next(file, octets, count);
  count = std::min(count, most_at_once);
  requests.push_back({Request::kWrite, std::string(static_cast<const char*>(octets), count)});
  return next(file, octets, count);
}
extern "C" int fsync(int file) {
  if (listening) requests.push_back({is_folder(file) ? Request::kSyncFolder : Request::kSync});
  return usual<int (*)(int)>("fsync")(file);
}
extern "C" int rename(const char* from, const char* to) noexcept {
  if (listening) requests.push_back({Request::kRename});
  return usual<int (*)(const char*, const char*)>("rename")(from, to);
}

namespace lodestar {
namespace {

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// What the file holds when the power falls after so many requests: what was not synced is there or not, as chance has
/// it.
std::string after_fall(std::size_t done, const std::string& old, std::mt19937& random) {
  const auto chance = [&] { return random() % 2 == 0; };
  std::string synced, written;
  bool renamed = false, name_synced = false;
  for (std::size_t i = 0; i < done; ++i) {
    if (requests[i].what == Request::kWrite) written += requests[i].octets;
    if (requests[i].what == Request::kSync) synced = written;
    if (requests[i].what == Request::kRename) renamed = true;
    if (requests[i].what == Request::kSyncFolder) name_synced = renamed;
  }
  for (std::size_t i = synced.size(); i < written.size(); ++i) synced += chance() ? written[i] : '\0';
  return name_synced || (renamed && chance()) ? synced : old;
}

TEST(ReplaceFile, AFallOfPowerLeavesTheOldOrTheNew) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "file", old = "what was there before", next = std::string(1000, 'n') + "ew";
  ASSERT_TRUE(replace_file(path, old));
  most_at_once = 100;
  listening = true;
  const bool replaced = replace_file(path, next);
  listening = false;
  ASSERT_TRUE(replaced);
  EXPECT_EQ(content(path), next);
  ASSERT_GT(requests.size(), 11u);
  std::mt19937 random(1);
  for (std::size_t done = 0; done <= requests.size(); ++done)
    for (int fall = 0; fall < 50; ++fall) {
      const std::string found = after_fall(done, old, random);
      ASSERT_TRUE(found == next || (done < requests.size() && found == old)) << "after " << done << " requests";
    }
}

TEST(ReplaceFile, SaysWhyItCannot) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(replace_file(folder / "missing/file", "x"));
  EXPECT_EQ(errno, ENOENT);
  std::filesystem::create_directory(folder / "taken");
  EXPECT_FALSE(replace_file(folder / "taken", "x"));
  EXPECT_EQ(errno, EISDIR);
}

}  // namespace
}  // namespace lodestar
