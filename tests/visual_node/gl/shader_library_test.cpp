#include "visual_node/gl/shader_library.h"

#include <catch2/catch.hpp>

#include "visual_node/gl/shader_text.h"

using namespace tactus::visual;

TEST_CASE("A shader of the folder precedes one of the scene, which precedes one of the node") {
  ShaderLibrary library({{.name = "stripes",
                          .fragment = "of the scene",
                          .vertex = "",
                          .fragment_file = "shaders/stripes.frag",
                          .vertex_file = ""}});
  REQUIRE(library.fragment("stripes"));
  CHECK(library.fragment("stripes")->text == "of the scene");
  CHECK(library.fragment("stripes")->name == "stripes.frag");
  CHECK(library.fragment("phong")->text == shader_text("phong.frag"));
  library.set({{"stripes.frag", "edited"}, {"phong.frag", "mine"}});
  // By the name of the file in the folder.
  CHECK(library.fragment("stripes")->text == "edited");
  CHECK(library.fragment("stripes")->name == "stripes.frag");
  CHECK(library.fragment("phong")->text == "mine");
  CHECK(library.source_file("phong.frag").text == "mine");
  library.set({});
  CHECK(library.fragment("stripes")->text == "of the scene");
  CHECK(library.fragment("phong")->text == shader_text("phong.frag"));
}

TEST_CASE("A file in the folder defines a look with its name") {
  ShaderLibrary library;
  CHECK_FALSE(library.fragment("wood"));
  library.set({{"wood.frag", "vec4 shade() { return base; }"}});
  REQUIRE(library.fragment("wood"));
  CHECK_FALSE(library.vertex("wood"));
  library.set({{"wood.frag", ""}, {"wood.vert", "vec3 moved(vec3 at) { return at; }"}});
  CHECK(library.vertex("wood"));
}

TEST_CASE("Every offered name exists, and a shader part is not a look") {
  const ShaderLibrary library;
  for (const char* name :
       {"phong", "gouraud", "normal_mapped", "textured", "reflecting", "greyscale", "blur", "edges"}) {
    CHECK(library.fragment(name));
    CHECK_THAT(library.names(), Catch::Contains(name));
  }
  for (const char* name :
       {"surface_end", "shadow", "glow", "sky", "upscale", "overlay", "", "../phong", "nowhere"})
    CHECK_FALSE(library.fragment(name));
  CHECK_THROWS_WITH(library.source_file("nowhere.vert"), Catch::Contains("nowhere.vert"));
}

TEST_CASE("A shader of the scene moves vertices when it has a vertex source") {
  ShaderText text{
      .name = "waves", .fragment = "f", .vertex = "v", .fragment_file = "a.frag", .vertex_file = "folder/b.vert"};
  ShaderLibrary library({text});
  REQUIRE(library.vertex("waves"));
  CHECK(library.vertex("waves")->text == "v");
  CHECK_FALSE(library.vertex("phong"));
  library.set({{"b.vert", "edited"}});
  CHECK(library.vertex("waves")->text == "edited");
  CHECK_THAT(library.names(), Catch::Contains("waves"));
}
