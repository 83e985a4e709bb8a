#include "sim_node/scene/meshes/obj_text.h"

#include <catch2/catch.hpp>

using namespace tactus::sim;

namespace {

std::string completed(std::string text) {
  complete_obj_text(text);
  return text;
}

}  // namespace

TEST_CASE("Numbers of an OBJ file that begin with a point get a zero") {
  CHECK(completed("v .5 -.25 +.125\n") == "v 0.5 -0.25 +0.125\n");
  CHECK(completed("vt\t.5 .5\r\nvn .1 .2 .3") == "vt\t0.5 0.5\r\nvn 0.1 0.2 0.3");
  CHECK(completed("  v 1 .5e-3 2.5\n") == "  v 1 0.5e-3 2.5\n");
  CHECK(completed("Kd .5 .5 .5\nd .25\n") == "Kd 0.5 0.5 0.5\nd 0.25\n");
}

TEST_CASE("Names, complete numbers and other lines of an OBJ file stay as they are") {
  for (const std::string text : {"mtllib .5.mtl\nusemtl .5\ng .5\n", "map_Kd .5.png\n", "v 0.5 1.25 -3.5\n", "# .5\n", "", "v", "v .", "v 1 2 .", "f 1/.5 2 3\n"}) {
    std::string same = text;
    CHECK_FALSE(complete_obj_text(same));
    CHECK(same == text);
  }
}

TEST_CASE("The byte order mark of an OBJ file is removed") {
  CHECK(completed("\xEF\xBB\xBFv 1 2 3\n") == "v 1 2 3\n");
}
