#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lodestar::test {

/// A node of the package as a process of its own, that a test can end and start again. Not by fork(): this process has
/// threads, and a lock that one of them held would stay locked.
class NodeProcess {
 public:
  /// @param log what it says @param preloaded library that is loaded before the program's own; empty: none
  explicit NodeProcess(const std::string& name, const std::string& log = "/dev/null", const std::string& preloaded = "")
      : log_(log) {
    std::string program = std::string(LODESTAR_PROGRAM_DIR) + "/" + name + "_node", argument = "__name:=" + name;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    std::string preload = "LD_PRELOAD=" + preloaded;
    std::vector<char*> environment;
    for (char** variable = environ; *variable != nullptr; ++variable) environment.push_back(*variable);
    if (!preloaded.empty()) environment.push_back(preload.data());
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int fault = posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments, environment.data());
    posix_spawn_file_actions_destroy(&actions);
    if (fault != 0) throw std::runtime_error(program + " does not start");
  }
  ~NodeProcess() { end(SIGKILL); }
  NodeProcess(const NodeProcess&) = delete;
  NodeProcess& operator=(const NodeProcess&) = delete;

  int end(int signal) {
    if (process_ <= 0) return 0;
    ::kill(process_, signal);
    return join();
  }
  int join() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return status;
  }
  std::string output() const {
    std::ifstream file(log_);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

 private:
  std::string log_;
  pid_t process_ = -1;
};

}  // namespace lodestar::test
