// read_pictures: decodes pictures in a confined process, for ConfinedPictures. Not for users: input and output are records
// (sync/sandbox/records.h).
#include <cstdio>
#include <span>
#include <stdexcept>
#include <unistd.h>

#include "sync/pictures/picture_decoders.h"
#include "sync/pictures/picture_packing.h"
#include "sync/sandbox/reader_program.h"

namespace {

constexpr char kHelp[] =
    "Usage: read_pictures\n\n"
    "Decodes PNG and JPEG pictures for the nodes, confined in a process of its own: it can read only its standard input.\n"
    "Input and output are binary.\n"
    "  --help   print this text\n";

std::vector<std::uint8_t> decode(std::span<const std::uint8_t> request) {
  using namespace tactus::sync;
  if (request.empty()) throw std::runtime_error("it is empty");
  const auto bytes = request.subspan(1);
  return request[0] == static_cast<std::uint8_t>(PictureKind::kHeightMap) ? pack(read_height_map(bytes)) : pack(read_raster(bytes));
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = tactus::sync::reader_options(argc, argv, kHelp)) return *status;
  if (argc != 1 || isatty(STDIN_FILENO)) {
    std::fprintf(stderr, "read_pictures: nodes start this program; it takes no file\n");
    return 1;
  }
  return tactus::sync::reader_session_main({}, {}, decode);
}
