#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace lodestar::test {

/// support/bridge_worker.cpp as a process that can be killed.
class Worker {
 public:
  Worker(const std::string& store, const std::string& events, const std::string& broker)
      : store_(store), events_(events), broker_(broker) {
    start();
  }
  ~Worker() { kill(); }

  void start() {
    process_ = fork();
    if (process_ != 0) return;
    execl(LODESTAR_BRIDGE_WORKER, LODESTAR_BRIDGE_WORKER, store_.c_str(), events_.c_str(), broker_.c_str(), nullptr);
    _exit(127);
  }
  void kill() {
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }

 private:
  std::string store_, events_, broker_;
  pid_t process_ = -1;
};

}  // namespace lodestar::test
