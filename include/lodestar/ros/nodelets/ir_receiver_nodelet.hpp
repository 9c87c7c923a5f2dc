#pragma once

#include <nodelet/nodelet.h>

#include <memory>
#include <string>

#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/host_clock.hpp"
#include "lodestar/ros/nodelets/serial_line.hpp"
#include "lodestar/sensing/irlink/board_link.hpp"

namespace lodestar {

/// A receiver board on a serial line in, `ir/frames` out (docs/nodes/ir_receiver.md).
class IrReceiverNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void poll();
  void take(const std::uint8_t* bytes, std::size_t count);
  void report(Health::Status& status);

  std::string frame_id_;
  std::unique_ptr<Health> health_;
  StreamWatch* packets_watch_ = nullptr;
  ros::Publisher frames_;
  std::unique_ptr<BoardLink> link_;
  HostClock host_clock_;
  std::unique_ptr<SerialLine> line_;
  std::string told_fault_;  ///< of the line, in the log
  ros::WallTimer poll_;
};

}  // namespace lodestar
