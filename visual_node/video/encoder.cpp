#include "visual_node/video/encoder.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace tactus::visual {
namespace {

// Room for two pictures of 640x480, which reduces switches between the two processes.
constexpr int kPipeBytes = 1 << 20;
constexpr auto kWaitInterval = std::chrono::milliseconds(10);
constexpr int kMaxIdleWaits = 1000;  // 10 s

// Processor time that a process has used, ns; 0: unknown.
std::int64_t processor_time_ns(pid_t process) {
  clockid_t clock;
  timespec used{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
}

}  // namespace

std::vector<std::string> encoder_command(const std::string& file, int width, int height, double rate_Hz, int crf) {
  const std::string half_second = std::to_string(std::max(1, static_cast<int>(std::lround(rate_Hz / 2))));
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-nostdin",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "yuv420p",
          "-s",
          std::to_string(width) + "x" + std::to_string(height),
          "-framerate",
          std::to_string(rate_Hz),
          "-i",
          "pipe:0",
          "-an",
          "-c:v",
          "libx264",
          "-preset",
          "ultrafast",
          "-crf",
          std::to_string(crf),
          "-threads",
          "1",
          "-g",
          half_second,
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "iec61966-2-1",
          "-color_range",
          "tv",
          "-movflags",
          "+frag_keyframe+empty_moov+default_base_moof",
          "-flush_packets",
          "1",
          "-y",
          file};
}

Encoder::Encoder(const std::vector<std::string>& command) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("no pipe to the video encoder: ") + std::strerror(errno));
  fcntl(ends[1], F_SETPIPE_SZ, kPipeBytes);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // In its own process group: Ctrl-C ends the node, and the encoder ends with its input. SIGPIPE, which the node
  // ignores, gets its default action.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSCHEDULER);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  const sched_param normal{};
  posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
  posix_spawnattr_setschedparam(&attributes, &normal);

  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error = posix_spawnp(&child_, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    child_ = -1;
    throw std::runtime_error("no video: " + command[0] + " cannot be started (" + std::strerror(error) +
                             "); install ffmpeg");
  }
  pipe_ = ends[1];
  setpriority(PRIO_PROCESS, static_cast<id_t>(child_), 10);
}

Encoder::~Encoder() {
  if (child_ < 0) return;
  close(pipe_);
  // On a busy machine the encoder needs long for the last pictures; only one that does nothing hangs.
  std::int64_t used_ns = 0;
  for (int idle = 0; idle < kMaxIdleWaits; ++idle) {
    if (waitpid(child_, nullptr, WNOHANG) != 0) return;
    std::this_thread::sleep_for(kWaitInterval);
    if (const std::int64_t now_ns = processor_time_ns(child_); now_ns > used_ns) idle = 0, used_ns = now_ns;
  }
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

bool Encoder::finish() {
  close(pipe_);
  int status = -1;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
  child_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool Encoder::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(pipe_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace tactus::visual
