#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
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

/// A port of the loopback that nobody has now.
inline int free_port() {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(s, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(s, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no free port");
  close(s);
  return ntohs(address.sin_port);
}

/// mosquitto on the loopback, without persistence: what it holds dies with it.
class Broker {
 public:
  /// @param extra lines of its configuration; empty: everyone may come
  explicit Broker(std::string extra = "") : port_(free_port()), extra_(std::move(extra)) { start(); }
  ~Broker() { kill(); }
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  static bool installed() { return std::system("PATH=$PATH:/usr/sbin command -v mosquitto >/dev/null") == 0; }

  int port() const { return port_; }
  std::string uri() const { return "tcp://127.0.0.1:" + std::to_string(port_); }

  /// Listens when this returns.
  void start() {
    const std::string file = folder_ / "mosquitto.conf";
    std::ofstream(file) << "log_dest none\nset_tcp_nodelay true\nlistener " << port_ << " 127.0.0.1\n"
                        << (extra_.empty() ? "allow_anonymous true" : extra_) << "\n";
    process_ = fork();
    if (process_ == 0) {
      execlp("mosquitto", "mosquitto", "-c", file.c_str(), nullptr);
      execl("/usr/sbin/mosquitto", "mosquitto", "-c", file.c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 500 && !listens(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
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
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool connected = connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    close(s);
    return connected;
  }

  TemporaryFolder folder_;
  int port_;
  std::string extra_;
  pid_t process_ = -1;
};

}  // namespace lodestar::test
