// Tests of the files that settings name.
#include "audio_node/named_files.h"

#include <catch2/catch.hpp>

using namespace tactus::audio;
using Catch::Contains;

TEST_CASE("The files of the default settings are accepted") { CHECK_NOTHROW(check_named_files({})); }

TEST_CASE("A setting that names a file or folder that does not exist is refused, also while another setting leaves it unused") {
  Settings ears, loudspeakers, recordings;
  ears.hrtf_file = "/nowhere/ears.sofa", ears.spatial = "stereo";
  loudspeakers.layout_file = "/nowhere/room.csv", loudspeakers.spatial = "hrtf";
  recordings.sounds = "/nowhere/sounds", recordings.method = "modal";
  CHECK_THROWS_WITH(check_named_files(ears), Contains("/nowhere/ears.sofa"));
  CHECK_THROWS_WITH(check_named_files(loudspeakers), Contains("/nowhere/room.csv"));
  CHECK_THROWS_WITH(check_named_files(recordings), Contains("/nowhere/sounds"));
}
