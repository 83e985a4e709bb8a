// Arbitrary text read as a scene: rejected with one sentence, or a world.
#include <cstdlib>
#include <stdexcept>

#include "sim_node/scene/load_sdf.h"
#include "tests/fuzz/file_of.h"

namespace {

// Copies the files that scenes refer to into their folder.
bool copy_assets(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(TACTUS_SOURCE_DIR "/sim_node/scenes"))
    if (entry.is_regular_file() && entry.path().extension() != ".sdf")
      std::filesystem::copy_file(entry.path(), folder / entry.path().filename(), error);
  return !error;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf file("scene.sdf");
  static const bool beside = copy_assets(file.folder());
  if (!beside) std::abort();
  file.write(data, size);
  std::vector<std::string> warnings;
  try {
    tactus::sim::load_sdf(file.path(), warnings, {.confined = false});
  } catch (const std::runtime_error& e) {
    if (*e.what() == 0) std::abort();
  }
  return 0;
}
