#include "sync/text/error_text.h"

#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

namespace tactus::sync {
namespace {

// nlohmann::json writes "[json.exception.type_error.302] type must be number, but is string".
constexpr std::string_view kJson = "[json.exception.";

std::string json_text(const std::string& what) {
  const std::size_t end = what.find("] ");
  return "a value in this JSON is missing or has another type than expected (" + (end == std::string::npos ? what : what.substr(end + 2)) +
         "); correct it";
}

}  // namespace

std::string error_text(const std::exception& e) {
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&e)) {
    const std::string other = file->path2().empty() ? "" : " to " + file->path2().string();
    return file->path1().string() + other + ": " + file->code().message() + "; check the path and its permissions";
  }
  // std::thread gives only the reason.
  const auto* refused = dynamic_cast<const std::system_error*>(&e);
  if (refused && refused->what() == refused->code().message())
    return "the system refuses a thread (" + refused->code().message() + "); raise the limits of this user, see ulimit -a";
  if (dynamic_cast<const std::bad_alloc*>(&e)) return "there is not enough memory; close other programs, raise ulimit -v, or give a smaller input";
  const std::string what = e.what();
  return what.starts_with(kJson) ? json_text(what) : what;
}

}  // namespace tactus::sync
