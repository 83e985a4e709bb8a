// A folder of recordings by materials and interaction; README.md describes its layout.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "audio_node/samples/layers.h"
#include "audio_node/samples/recording_file.h"

namespace tactus::audio {

// Two materials in alphabetical order; for a single one the first is empty.
using MaterialPair = std::pair<std::string, std::string>;
MaterialPair pair_of(const std::string& a, const std::string& b);

class Database {
 public:
  // Result for two materials: recordings of the pair, or of each alone.
  struct Found {
    const Layers* pair = nullptr;
    std::array<const Layers*, 2> alone{};  // of the first and of the second material
    bool any() const { return pair || alone[0] || alone[1]; }
  };
  // Materials without a name are never found.
  Found find(const std::string& a, const std::string& b, Interaction interaction) const;

  struct Key {
    MaterialPair materials;
    Interaction interaction;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, Layers> sounds;
  std::vector<SoundFault> faults;
  std::size_t bytes = 0;

 private:
  const Layers* of(const MaterialPair& materials, Interaction interaction) const;
};

// Reads the whole folder, which may take seconds: do not call it in a loop. Broken files are left out and listed
// in `faults`, and so is a missing folder.
Database read_database(const std::string& folder, double rate_Hz, double size_m);

}  // namespace tactus::audio
