#include "sync/log/log_parts.h"

#include <charconv>
#include <filesystem>
#include <map>

namespace tactus::sync {

namespace {

std::string name_of(int number) {
  return number == 1 ? "run.lcmlog" : "run." + std::to_string(number) + ".lcmlog";
}

// 0: not the name of a part.
int number_of(const std::string& name) {
  if (name == name_of(1)) return 1;
  int number = 0;
  if (name.rfind("run.", 0) != 0 ||
      std::from_chars(name.data() + 4, name.data() + name.size(), number).ec != std::errc())
    return 0;
  return number > 1 && name == name_of(number) ? number : 0;
}

// The parts of the log in this folder, by number.
std::map<int, std::string> parts_by_number(const std::string& dir) {
  std::map<int, std::string> parts;
  std::error_code unreadable;
  for (std::filesystem::directory_iterator i(dir, unreadable), end; !unreadable && i != end;
       i.increment(unreadable))
    if (const int number = number_of(i->path().filename().string()); number > 0)
      parts[number] = i->path().string();
  return parts;
}

}  // namespace

std::vector<std::string> log_parts_in(const std::string& dir) {
  std::vector<std::string> paths;
  for (const auto& [number, path] : parts_by_number(dir)) paths.push_back(path);
  return paths;
}

std::unique_ptr<LogSink> LogParts::open() {
  if (next_ == 0) {
    const auto existing = parts_by_number(dir_);
    next_ = existing.empty() ? 1 : existing.rbegin()->first + 1;
  }
  std::filesystem::path path;
  do path = std::filesystem::path(dir_) / name_of(next_);
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
    std::error_code ignored;  // another process has removed it already
    std::filesystem::remove(parts_.front().path, ignored);
    parts_.pop_front();
  }
}

}  // namespace tactus::sync
