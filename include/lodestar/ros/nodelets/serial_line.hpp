#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <string>

namespace lodestar {

/// A serial device, 8N1 without flow control whatever the port was left with, that may be unplugged and plugged in
/// again at any time: it is opened anew four times a second until it is there. No thread: whoever owns it polls.
class SerialLine {
 public:
  using OnBytes = std::function<void(const std::uint8_t* bytes, std::size_t count)>;

  /// Whether a serial device can be set to it: the system knows certain rates alone.
  static bool is_baud_rate(unsigned baud);

  /// @param on_cut the device is gone
  SerialLine(std::string device, unsigned baud, OnBytes on_bytes, std::function<void()> on_cut);

  /// Makes the calls for what has happened since; returns soon, whatever the line sends.
  void poll();

  /// Why the device is not open; empty when it is.
  const std::string& fault() const { return fault_; }

 private:
  void open();
  void read();
  void lose(const std::string& why);

  std::string device_;
  unsigned baud_;
  OnBytes on_bytes_;
  std::function<void()> on_cut_;
  std::string fault_;
  std::array<std::uint8_t, 4096> buffer_{};
  boost::asio::io_context io_;
  boost::asio::serial_port port_{io_};
  boost::asio::steady_timer retry_{io_};
};

}  // namespace lodestar
