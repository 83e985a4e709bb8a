// read_sounds sofa FILE: parses a file of sounds in a confined process, for load_sofa. Not for users: the output is a
// record (sync/sandbox/records.h).
#include <cstdio>
#include <cstring>

#include "audio_node/spatial/sofa.h"
#include "sync/sandbox/reader_program.h"

namespace {

constexpr char kHelp[] =
    "Usage: read_sounds sofa FILE\n\n"
    "Parses a SOFA file for audio_node, confined in a process of its own: it can read only FILE.\n"
    "FILE is an absolute path. The output is binary.\n"
    "  --help   print this text\n";

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = tactus::sync::reader_options(argc, argv, kHelp)) return *status;
  if (argc != 3 || std::strcmp(argv[1], "sofa") != 0 || argv[2][0] != '/') {
    std::fprintf(stderr, "read_sounds: no file; audio_node starts this program\n");
    return 1;
  }
  return tactus::sync::reader_main({argv[2]}, {}, [&](const tactus::sync::SendRecord& send) {
    send('R', tactus::audio::pack(tactus::audio::parse_sofa(argv[2])));
  });
}
