#include "visual_node/gl/shader_watch.h"

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>

#include "sync/text/csv.h"

namespace tactus::visual {
namespace {

constexpr std::uintmax_t kMaxBytes = 65536;      // design: ten times our longest shader
constexpr std::size_t kMaxFiles = 64;            // design
constexpr std::chrono::milliseconds kPollInterval{400};  // design: the time to look up from the editor

}  // namespace

struct ShaderWatch::Shared {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::optional<ShaderFolder> changed;
};

ShaderFolder read_shader_folder(const std::string& folder) {
  ShaderFolder files;
  std::error_code none;
  for (std::filesystem::directory_iterator it(folder, none), end; !none && it != end && files.size() < kMaxFiles;
       it.increment(none)) {
    const std::string kind = it->path().extension().string();
    if (kind != ".frag" && kind != ".vert" && kind != ".glsl") continue;
    if (auto text = sync::read_small_file(it->path(), kMaxBytes))
      files.emplace(it->path().filename().string(), std::move(*text));
  }
  return files;
}

ShaderWatch::ShaderWatch(const std::string& folder) {
  if (folder.empty()) return;
  shared_ = std::make_shared<Shared>();
  thread_ = std::jthread([shared = shared_, folder](const std::stop_token& stop) {
    ShaderFolder known;
    while (!stop.stop_requested()) {
      ShaderFolder now = read_shader_folder(folder);
      std::unique_lock lock(shared->mutex);
      if (now != known) shared->changed = known = std::move(now);
      shared->ended.wait_for(lock, stop, kPollInterval, [] { return false; });
    }
  });
}

// The thread is detached, not joined: it may be blocked on a folder that is no longer reachable.
ShaderWatch::~ShaderWatch() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.detach();
}

std::optional<ShaderFolder> ShaderWatch::take_change() {
  if (!shared_) return {};
  const std::unique_lock lock(shared_->mutex, std::try_to_lock);
  if (!lock.owns_lock() || !shared_->changed) return {};
  return std::exchange(shared_->changed, std::nullopt);
}

}  // namespace tactus::visual
