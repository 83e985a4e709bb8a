// Saved states of a world by name: in memory, and in files that a background thread reads and writes, so that the
// disk delays no step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sync/node/background_task.h"

namespace tactus::sim {

class StateStore {
 public:
  using Bytes = std::vector<std::uint8_t>;
  static constexpr std::size_t kMax = 16;
  static constexpr std::size_t kMaxBytes = 256u << 20;  // of a file, bytes

  explicit StateStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Letters, digits, "_" and "-", at most 64: the name cannot be a path.
  static bool valid_name(const std::string& name);

  // False: kMax states of other names are stored already.
  bool add(const std::string& name, Bytes bytes);
  const Bytes* find(const std::string& name) const;
  std::filesystem::path file_of(const std::string& name) const { return folder_ / (name + ".state"); }

  // Starts to write or read the file of a name; one operation at a time.
  bool busy() const { return work_.has_value(); }
  void begin_write(const std::string& name);
  void begin_read(const std::string& name);
  // The result of the operation once it is done: the bytes read, empty after writing, or an error sentence.
  struct Done {
    Bytes bytes;
    std::string error;
  };
  std::optional<Done> poll();

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const Bytes>> states_;
  std::optional<sync::BackgroundTask<Done>> work_;
};

}  // namespace tactus::sim
