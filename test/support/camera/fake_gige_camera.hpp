#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

namespace lodestar::test {

/// Aravis' fake GigE Vision camera as a process of its own, on 127.0.0.1. It has the port of all such cameras: whoever
/// else on this machine tests with one waits until this one is gone.
class FakeGigeCamera {
 public:
  static constexpr const char* kUri = "gige:127.0.0.1";

  explicit FakeGigeCamera(int lost_packets_per_thousand = 0) : lost_(std::to_string(lost_packets_per_thousand)) {
    flock(lock_, LOCK_EX);
    plug_in();
  }
  ~FakeGigeCamera() {
    unplug();
    close(lock_);
  }
  FakeGigeCamera(const FakeGigeCamera&) = delete;
  FakeGigeCamera& operator=(const FakeGigeCamera&) = delete;

  static bool installed() { return access(kProgram, X_OK) == 0; }

  void plug_in() {
    process_ = fork();
    if (process_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that dies leaves the port to the next
      execl(kProgram, kProgram, "-i", "127.0.0.1", "-r", lost_.c_str(), nullptr);
      _exit(127);
    }
    for (int waited_ms = 0; !listens() && waited_ms < 30000; waited_ms += 5)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  void unplug() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  void freeze() { kill(process_, SIGSTOP); }
  void thaw() { kill(process_, SIGCONT); }

 private:
  /// Whether somebody has the control port of GigE Vision cameras on 127.0.0.1, as the kernel's table has it.
  static bool listens() {
    std::ifstream table("/proc/net/udp");
    for (std::string line; std::getline(table, line);)
      if (line.find("0100007F:0F74") != std::string::npos) return true;
    return false;
  }

  static constexpr const char* kProgram = "/usr/bin/arv-fake-gv-camera-0.8";
  int lock_ = open("/tmp/lodestar_fake_gige_camera.lock", O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  std::string lost_;
  pid_t process_ = 0;
};

}  // namespace lodestar::test
