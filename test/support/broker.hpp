#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/temporary_folder.hpp"

namespace lodestar::test {

/// A port of the loopback that is the test's own, also while nobody listens there. Below those that the kernel gives to
/// whoever asks for any.
class OwnPort {
 public:
  OwnPort() {
    for (number_ = 21000; number_ < 32000; ++number_) {
      const std::string file = "/tmp/lodestar_port_" + std::to_string(number_) + ".lock";
      lock_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0 && is_free()) return;
      close(lock_);
    }
    throw std::runtime_error("no free port");
  }
  ~OwnPort() { close(lock_); }
  OwnPort(const OwnPort&) = delete;
  OwnPort& operator=(const OwnPort&) = delete;

  int number() const { return number_; }

 private:
  bool is_free() const {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    const int reuse = 1;
    setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(number_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool free = bind(s, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    close(s);
    return free;
  }

  int number_ = 0, lock_ = -1;
};

/// mosquitto on the loopback, without persistence: what it holds dies with it.
class Broker {
 public:
  /// @param extra lines of its configuration; empty: everyone may come
  explicit Broker(std::string extra = "") : extra_(std::move(extra)) { start(); }
  ~Broker() { kill(); }
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  static bool installed() { return std::system("PATH=$PATH:/usr/sbin command -v mosquitto >/dev/null") == 0; }

  int port() const { return port_.number(); }
  std::string uri() const { return "tcp://127.0.0.1:" + std::to_string(port()); }

  /// Listens when this returns.
  void start() {
    const std::string file = folder_ / "mosquitto.conf";
    std::ofstream(file) << "log_dest none\nset_tcp_nodelay true\nlistener " << port() << " 127.0.0.1\n"
                        << (extra_.empty() ? "allow_anonymous true" : extra_) << "\n";
    process_ = fork();
    if (process_ == 0) {
      execlp("mosquitto", "mosquitto", "-c", file.c_str(), nullptr);
      execl("/usr/sbin/mosquitto", "mosquitto", "-c", file.c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 6000 && !listens(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!listens()) throw std::runtime_error("mosquitto did not start: is it installed?");
  }

  /// SIGKILL: it has no time to do anything.
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  bool listens() const {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool connected = connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    close(s);
    return connected;
  }

  TemporaryFolder folder_;
  OwnPort port_;
  std::string extra_;
  pid_t process_ = -1;
};

}  // namespace lodestar::test
