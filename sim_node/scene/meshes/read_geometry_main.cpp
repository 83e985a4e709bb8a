// read_geometry FILE [FOLDER...]: parses a geometry file in a confined process, for read_mesh_parts_confined. Not for
// users: the output is a record (sync/sandbox/records.h).
#include <cstdio>

#include "sim_node/scene/meshes/mesh_packing.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sync/sandbox/reader_program.h"

namespace {

constexpr char kHelp[] =
    "Usage: read_geometry FILE [FOLDER...]\n\n"
    "Parses a file of geometry for sim_node, confined in a process of its own: it can read only FILE and the FOLDERs.\n"
    "FILE is an absolute path. The output is binary. To convert geometry, use tactus convert.\n"
    "  --help   print this text\n";

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = tactus::sync::reader_options(argc, argv, kHelp)) return *status;
  if (argc < 2 || argv[1][0] != '/') {
    std::fprintf(stderr, "read_geometry: no file; sim_node starts this program, and tactus convert is for users\n");
    return 1;
  }
  const std::filesystem::path file(argv[1]);
  const std::vector<std::filesystem::path> folders(argv + 2, argv + argc);
  std::vector<std::filesystem::path> readable = folders;
  if (readable.empty()) readable.push_back(file.parent_path());
  readable.push_back(file);
  return tactus::sync::reader_main(readable, {}, [&](const tactus::sync::SendRecord& send) {
    send('R', tactus::sim::pack(tactus::sim::read_mesh_parts(file, folders)));
  });
}
