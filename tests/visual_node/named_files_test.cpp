// Tests of the files that settings name.
#include "visual_node/named_files.h"

#include <catch2/catch.hpp>

using namespace tactus::visual;
using Catch::Contains;

TEST_CASE("The files of the default settings and the shipped rooms are accepted") {
  CHECK_NOTHROW(check_named_files({}));
  Settings room;
  room.room = "cave4", room.wall = "left";
  CHECK_NOTHROW(check_named_files(room));
}

TEST_CASE("A setting that names a room, a wall or a folder that does not exist is refused") {
  Settings room, wall, shaders;
  room.room = "/nowhere/room.csv";
  wall.room = "cave4", wall.wall = "ceiling";
  shaders.shader_folder = "/nowhere/shaders";
  CHECK_THROWS_WITH(check_named_files(room), Contains("/nowhere/room.csv"));
  CHECK_THROWS_WITH(check_named_files(wall), Contains("no wall ceiling"));
  CHECK_THROWS_WITH(check_named_files(shaders), Contains("/nowhere/shaders"));
}
