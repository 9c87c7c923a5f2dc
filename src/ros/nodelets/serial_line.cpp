#include "lodestar/ros/nodelets/serial_line.hpp"

#include <termios.h>

#include <boost/asio/buffer.hpp>

namespace lodestar {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr std::chrono::milliseconds kRetry{250};
constexpr int kMostCalls = 8;  // of one poll
}  // namespace

SerialLine::SerialLine(std::string device, unsigned baud, OnBytes on_bytes, std::function<void()> on_cut)
    : device_(std::move(device)), baud_(baud), on_bytes_(std::move(on_bytes)), on_cut_(std::move(on_cut)) {
  open();
}

bool SerialLine::is_baud_rate(unsigned baud) {
  termios settings{};
  error_code error;
  asio::serial_port::baud_rate(baud).store(settings, error);
  return !error;
}

void SerialLine::poll() {
  for (int call = 0; call < kMostCalls && io_.poll_one() > 0; ++call) continue;
}

void SerialLine::open() {
  using Port = asio::serial_port;
  error_code error;
  const auto set = [&](const auto& option) {
    if (!error) port_.set_option(option, error);
  };
  port_.open(device_, error);
  set(Port::baud_rate(baud_));
  set(Port::character_size(8));
  set(Port::parity(Port::parity::none));
  set(Port::stop_bits(Port::stop_bits::one));
  set(Port::flow_control(Port::flow_control::none));
  if (error) return lose(error.message());
  fault_.clear();
  read();
}

void SerialLine::read() {
  port_.async_read_some(asio::buffer(buffer_), [this](const error_code& error, std::size_t count) {
    if (error) {
      on_cut_();
      return lose(error.message());
    }
    on_bytes_(buffer_.data(), count);
    read();
  });
}

void SerialLine::lose(const std::string& why) {
  fault_ = device_ + ": " + why;
  error_code ignored;
  port_.close(ignored);
  retry_.expires_after(kRetry);
  retry_.async_wait([this](const error_code& error) {
    if (!error) open();
  });
}

}  // namespace lodestar
