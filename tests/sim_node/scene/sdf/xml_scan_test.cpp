// Counting an XML file before it is parsed.
#include "sim_node/scene/sdf/xml_scan.h"

#include "lcmtypes/utf8.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;

TEST_CASE("Elements, attributes, comments and declarations are counted, and not elements inside of comments, text or values") {
  const auto parts = [](const char* text) { return sdf::count_xml(text).parts; };
  CHECK(parts("") == 0);
  CHECK(parts("no elements = \"at all\"") == 0);
  CHECK(parts("<a/>") == 1);
  CHECK(parts("<a b='1' c=\"2\">x = 'y'</a>") == 4);  // the end of an element counts
  CHECK(parts("<?xml version='1.0'?><!DOCTYPE a><!-- <b c='d'/> --><a><![CDATA[<b c='d'/>]]></a>") == 6);
  CHECK(parts("<a b='>' c='<d e=\"f\">'/>") == 3);
  for (const char* damaged : {"<", "<a", "<a b='", "<a b='>", "<!--", "<!-- >", "<![CDATA[", "<?", "<a b='1'"}) CHECK(parts(damaged) <= 2);
  const sdf::XmlCount count = sdf::count_xml("<a>\n<b c='1'/>\n<d e='1' f='2'/></a>");
  CHECK(count.max_attributes == 2);
  CHECK(count.line == 3);
}

TEST_CASE("An element with very many attributes is refused before it is parsed, also when its values look like tags") {
  // tinyxml2 takes minutes for these, because it compares each attribute with all others.
  for (const char* value : {"1", ">", "<", "<a>"}) {
    std::string attributes;
    for (int i = 0; i < 200'000; ++i) attributes += " a" + std::to_string(i) + "='" + value + "'";
    SceneFile file(world("\n<a" + attributes + "/>"));
    CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("256 attributes"));
  }
}

TEST_CASE("A file of very many comments is refused before it is parsed") {
  // tinyxml2 keeps each of them: three bytes take more than a hundred.
  for (const std::string each : {"<!>", "x<!>"}) {
    std::string comments;
    for (int i = 0; i < 2'600'000; ++i) comments += each;
    SceneFile file(world(comments));
    CHECK_THAT(file.load_error(), Catch::Contains("more than 2500000 elements, attributes and comments"));
  }
}

TEST_CASE("Comments of an included file count for each include") {
  SceneFile file;
  std::string comments, includes;
  for (int i = 0; i < 10'000; ++i) comments += "<!-- -->";
  for (int i = 0; i < 110; ++i) includes += "<include><uri>part.sdf</uri><name>m" + std::to_string(i) + "</name></include>";
  file.write("part.sdf", "<sdf version='1.9'>" + comments + "<model name='m'><link name='l'/></model></sdf>");
  file.write("scene.sdf", world(includes));
  CHECK_THAT(file.load_error(), Catch::Contains("the copies of included files have more than 1000000 elements"));
}

TEST_CASE("Messages cut a name or a value between two characters") {
  std::string text = "x";
  while (text.size() < 4000) text += "\u00e4";
  for (const std::string& inside : {"<model name='" + text + "'><link name='l'/></model>", "<gravity>" + text + "</gravity>",
                                    "<model name='m'><link name='l'/><frame name='f' attached_to='" + text + "'/></model>"}) {
    SceneFile file(world(inside));
    const std::string error = file.load_error();
    CHECK(error.size() > 100);
    CHECK(tactus::is_text_line(error));
  }
}

TEST_CASE("Messages are short for names and values of any length") {
  const std::string text(1 << 20, 'x');
  SceneFile file(world("<model name='m'><link name='l'><" + text + "/></link><frame name='f' attached_to='" + text + "'/></model>"));
  CHECK(file.load_error().size() < 2000);
  file.write("scene.sdf", world("<model name='" + text + "'><link name='l'/></model>"));
  CHECK_THAT(file.load_error(), Catch::Contains("256 bytes") && !Catch::Contains(std::string(200, 'x')));
  std::string elements;
  for (int i = 0; i < 2000; ++i) elements += "<x" + std::string(1000, 'y') + "/>";
  file.write("scene.sdf", world(elements));
  CHECK(file.load_error() == "");
  CHECK(file.warnings.size() == 1001);
}
