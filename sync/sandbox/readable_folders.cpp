#include "sync/sandbox/readable_folders.h"

#include <algorithm>

namespace tactus::sync {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& part) { return part.native().starts_with('.'); }

}  // namespace

ReadableFolders::ReadableFolders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    // An empty path is the folder of a file that is named without one.
    const fs::path real = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (!error && fs::is_directory(real, error) && std::find(folders_.begin(), folders_.end(), real) == folders_.end())
      folders_.push_back(real);
  }
}

std::optional<fs::path> ReadableFolders::resolve(const fs::path& file) const {
  if (file.native().find('\0') != std::string::npos) return std::nullopt;
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) return std::nullopt;
  for (const fs::path& folder : folders_) {
    const auto [end, inside] = std::mismatch(folder.begin(), folder.end(), real.begin(), real.end());
    if (end == folder.end() && std::none_of(inside, real.end(), is_hidden)) return real;
  }
  return std::nullopt;
}

}  // namespace tactus::sync
