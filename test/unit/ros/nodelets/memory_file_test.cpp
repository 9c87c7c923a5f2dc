#include "lodestar/ros/nodelets/memory_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::TemporaryFolder;

class MemoryFileTest : public testing::Test {
 protected:
  void load() {
    file_.load([](const std::string& octets) { return octets == "good"; }, "all is lost");
  }
  static std::string held(const std::string& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool told(const std::string& words) const { return file_.fault().find(words) != std::string::npos; }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "memory";
  MemoryFile file_{path_};
};

TEST_F(MemoryFileTest, what_is_saved_is_loaded_and_no_file_is_no_fault) {
  load();
  file_.save("good");
  load();
  EXPECT_EQ(file_.fault(), "");
}

TEST_F(MemoryFileTest, what_cannot_be_understood_is_set_aside_and_the_loss_is_told_until_the_next_start) {
  std::ofstream(path_) << "bad";
  load();
  EXPECT_EQ(held(path_ + ".broken"), "bad");
  EXPECT_TRUE(told("set aside as " + path_ + ".broken, and all is lost")) << file_.fault();
  file_.save("good");
  EXPECT_EQ(held(path_), "good");
  EXPECT_TRUE(told("all is lost")) << file_.fault();
}

TEST_F(MemoryFileTest, what_cannot_be_read_is_left_as_it_is) {
  std::filesystem::create_directory(path_);
  load();
  EXPECT_TRUE(told("cannot be read: Is a directory, and all is lost; nothing new is kept")) << file_.fault();
  file_.save("good");
  EXPECT_TRUE(told("cannot be read")) << file_.fault();
  EXPECT_TRUE(std::filesystem::is_directory(path_));
  EXPECT_FALSE(std::filesystem::exists(path_ + ".broken"));
}

TEST_F(MemoryFileTest, what_cannot_be_set_aside_is_told_and_not_written_over) {
  std::ofstream(path_) << "bad";
  std::filesystem::create_directory(path_ + ".broken");
  load();
  EXPECT_TRUE(told("not set aside, ")) << file_.fault();
  file_.save("good");
  EXPECT_EQ(held(path_), "bad");
}

}  // namespace
}  // namespace lodestar
