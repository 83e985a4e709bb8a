#include "sim_node/scene/sdf/regular_file.h"

#include <fstream>
#include <stdexcept>
#include <string>

namespace tactus::sim {

void check_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error("it does not exist");
  if (!std::filesystem::is_regular_file(status)) throw std::runtime_error("it is not a regular file");
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) throw std::runtime_error("it is not readable");
  if (bytes > max_bytes) throw std::runtime_error("it is larger than " + std::to_string(max_bytes >> 20) + " MiB");
}

sync::Bytes read_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  check_regular_file(file, max_bytes);
  std::ifstream in(file, std::ios::binary);
  sync::Bytes bytes(std::filesystem::file_size(file));
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    throw std::runtime_error("it is not readable");
  return bytes;
}

}  // namespace tactus::sim
