// read_sounds sofa FILE: parses a SOFA file in a confined process, for load_sofa.
// read_sounds recordings FOLDER: reads recordings below it, for RecordingReader.
// Not for users: input and output are records (sync/sandbox/records.h).
#include <cstdio>
#include <cstring>

#include "audio_node/samples/recording_reader.h"
#include "audio_node/spatial/sofa.h"
#include "sync/sandbox/reader_program.h"

namespace {

constexpr char kHelp[] =
    "Usage: read_sounds sofa FILE\n"
    "       read_sounds recordings FOLDER\n\n"
    "Parses a SOFA file, or WAV and FLAC files, for audio_node, confined in a process of its own: it can read only FILE or FOLDER.\n"
    "FILE and FOLDER are absolute paths. Input and output are binary.\n"
    "  --help   print this text\n";

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = tactus::sync::reader_options(argc, argv, kHelp)) return *status;
  const bool named = argc == 3 && argv[2][0] == '/';
  if (named && std::strcmp(argv[1], "sofa") == 0)
    return tactus::sync::reader_main({argv[2]}, {}, [&](const tactus::sync::SendRecord& send) {
      send('R', tactus::audio::pack(tactus::audio::parse_sofa(argv[2])));
    });
  if (named && std::strcmp(argv[1], "recordings") == 0)
    return tactus::sync::reader_session_main({argv[2]}, {}, tactus::audio::answer_request);
  std::fprintf(stderr, "read_sounds: no file; audio_node starts this program\n");
  return 1;
}
