// Counts what a COLLADA file expands to, before assimp allocates it.
#pragma once

#include <filesystem>

namespace tactus::sim {

// A node of a COLLADA file (.dae) may be used several times, also inside others that are used several times: a file of 3 kB
// can expand to billions of nodes. Throws std::runtime_error with one clause and its line when the file expands to more than
// kMaxMeshParts nodes and shapes, to more than 100 levels, or without end, and when it is not well-formed XML. Accepts
// every other file.
void check_collada(const std::filesystem::path& file);

}  // namespace tactus::sim
