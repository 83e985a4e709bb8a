// Reads a geometry file in a confined process: the program read_geometry (sync/sandbox/reader_process.h).
#pragma once

#include <filesystem>
#include <vector>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The same as read_mesh_parts (mesh_reader.h), bit by bit, for a file that may be hostile: its parser has limits of memory
// and processor time, and reaches no other file, no network and no other process. folders: as there. Takes some
// milliseconds more. Throws std::runtime_error with one clause.
MeshParts read_mesh_parts_confined(const std::filesystem::path& file, const std::vector<std::filesystem::path>& folders = {});

}  // namespace tactus::sim
