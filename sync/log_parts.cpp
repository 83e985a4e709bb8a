#include "sync/log_parts.h"

#include <filesystem>

namespace tactus::sync {

std::unique_ptr<LogSink> LogParts::open() {
  const std::filesystem::path folder(dir_);
  std::filesystem::path path;
  do path = folder / (next_ == 1 ? "run.lcmlog" : "run." + std::to_string(next_) + ".lcmlog");
  while (++next_, std::filesystem::exists(path));
  auto sink = std::make_unique<FileSink>(path.string());
  parts_.push_back({path.string()});
  return sink;
}

std::int64_t LogParts::bytes_before() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i + 1 < parts_.size(); ++i) sum += parts_[i].bytes;
  return sum;
}

void LogParts::prune(std::int64_t present_bytes) {
  if (parts_.empty()) return;
  parts_.back().bytes = present_bytes;
  const auto too_many = [&] { return limits_.keep > 0 && parts_.size() > static_cast<std::size_t>(limits_.keep); };
  const auto too_large = [&] {
    return limits_.max_bytes > 0 && bytes_before() + present_bytes > limits_.max_bytes;
  };
  while (parts_.size() > 1 && (too_many() || too_large())) {
    std::error_code ignored;  // somebody else has removed it: all the better
    std::filesystem::remove(parts_.front().path, ignored);
    parts_.pop_front();
    ++removed_;
  }
}

}  // namespace tactus::sync
