// Options of the detector "layers", from the settings.
#pragma once

#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Throws std::runtime_error with one sentence when the processor lacks the selected instruction set.
inline MeshContactOptions layer_options(const Settings& s) {
  return {.mode = s.contact_mode == "itouch2005" ? ContactMode::kItouch2005 : ContactMode::kComplete,
          .remover = s.duplicate_remover == "adjacency"     ? DuplicateRemover::kAdjacency
                     : s.duplicate_remover == "brute_force" ? DuplicateRemover::kBruteForce
                                                            : DuplicateRemover::kHashed,
          .isa = parse_isa(s.isa)};
}

}  // namespace tactus::sim
