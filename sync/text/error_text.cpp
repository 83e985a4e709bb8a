#include "sync/text/error_text.h"

#include <filesystem>

namespace tactus::sync {

std::string error_text(const std::exception& e) {
  const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&e);
  if (!file) return e.what();
  const std::string other = file->path2().empty() ? "" : " to " + file->path2().string();
  return file->path1().string() + other + ": " + file->code().message() + "; check the path and its permissions";
}

}  // namespace tactus::sync
