// Kept states of a world, by name: in memory, and in files that a thread of its own reads and writes, so that no
// disk holds back a step.
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
  static constexpr std::size_t kLargest = 256u << 20;  // of a file, bytes

  explicit StateStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Letters, digits, "_" and "-", at most 64: a name that is no path.
  static bool good_name(const std::string& name);

  // False: there are kMost of other names already.
  bool keep(const std::string& name, Bytes bytes);
  const Bytes* find(const std::string& name) const;
  std::filesystem::path file_of(const std::string& name) const { return folder_ / (name + ".state"); }

  // Begins to write or read the file of a name; one at a time.
  bool busy() const { return work_.has_value(); }
  void begin_write(const std::string& name);
  void begin_read(const std::string& name);
  // Once it is done: what was read, empty after writing, or a sentence that says why not.
  struct Done {
    Bytes bytes;
    std::string refused;
  };
  std::optional<Done> poll();

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const Bytes>> kept_;
  std::optional<sync::BackgroundTask<Done>> work_;
};

}  // namespace tactus::sim
