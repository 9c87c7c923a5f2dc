#include "lodestar/ros/nodelets/pallet_file.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "lodestar/PalletMemory.h"
#include "lodestar/ros/convert/pallet.hpp"
#include "support/pallet_truck.hpp"

namespace lodestar {
namespace {

using test::PalletTruck;

class PalletFileTest : public testing::Test {
 protected:
  PalletFileTest() { std::remove(path_.c_str()); }
  ~PalletFileTest() override { std::remove(path_.c_str()); }

  /// What the file holds, as it is to be after an edit.
  template <class Edit>
  void edit(Edit change) {
    std::ifstream in(path_, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t head = std::string(ros::message_traits::MD5Sum<PalletMemory>::value()).size();
    auto* octets = reinterpret_cast<std::uint8_t*>(&text[0]) + head;
    const auto size = static_cast<std::uint32_t>(text.size() - head);
    PalletMemory memory;
    ros::serialization::IStream from(octets, size);
    ros::serialization::deserialize(from, memory);
    change(memory);
    ros::serialization::OStream to(octets, size);
    ros::serialization::serialize(to, memory);
    std::ofstream(path_, std::ios::binary) << text;
  }

  std::string path_ = testing::TempDir() + "pallet_file_test.memory";
  PalletFile file_{path_, "map"};
};

TEST_F(PalletFileTest, WhatATruckTellsOutlivesARestartHoweverFarItGoes) {
  PalletTruck truck;
  truck.bring(9e3, 0, PalletTruck::sscc(1));
  truck.bring(1e200, 0, PalletTruck::sscc(2));
  truck.set_sigma(5e3);
  truck.bring(0, 0, PalletTruck::sscc(3));
  EXPECT_EQ(truck.pallet("id1").state, PalletState::kStanding);
  EXPECT_EQ(truck.pallet("id2").state, PalletState::kUncertain) << "nothing stands there";
  EXPECT_EQ(truck.pallet("id3").state, PalletState::kUncertain);
  file_.save(truck.tracker);
  PalletTruck later;
  file_.load_into(later.tracker);
  EXPECT_EQ(file_.fault(), "");
  ASSERT_EQ(later.tracker.pallets().all().size(), 3u);
  for (const auto& [id, change] : truck.tracker.pallets().all()) EXPECT_EQ(later.pallet(id).state, change.pallet.state);
}

TEST_F(PalletFileTest, APoseThatCannotBeLosesNoPallet) {
  PalletTruck truck;
  truck.bring(0, 0, PalletTruck::sscc(1));
  truck.bring(5, 0, PalletTruck::sscc(2));
  truck.stand(0, 0);
  truck.lift();
  file_.save(truck.tracker);
  edit([](PalletMemory& memory) {
    ASSERT_EQ(memory.events.size(), 5u);
    memory.events[3].pallet.pose.covariance[0] = INFINITY;
    memory.seats[0].pose.position.z = std::nan("");
  });
  PalletTruck later;
  file_.load_into(later.tracker);
  EXPECT_EQ(file_.fault(), "");
  ASSERT_EQ(later.tracker.pallets().all().size(), 2u);
  EXPECT_EQ(later.tracker.ledger().last(), 5u) << "no number is given twice";
  EXPECT_EQ(later.pallet("id2").state, PalletState::kUncertain) << "a person is asked where it is";
  EXPECT_EQ(later.pallet("id2").sscc, PalletTruck::sscc(2));
  EXPECT_TRUE(later.tracker.pallets().standing().empty());

  later.work(true, "", 0);
  const auto dropped = later.lower();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].pallet.id, "id1");
  EXPECT_EQ(dropped[0].pallet.state, PalletState::kUncertain) << "nobody knows how it sat on the fork";
}

}  // namespace
}  // namespace lodestar
