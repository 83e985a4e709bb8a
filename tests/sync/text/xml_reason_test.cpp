// Tests of the words for texts that are not XML.
#include "sync/text/xml_reason.h"

#include <tinyxml2.h>

#include <catch2/catch.hpp>
#include <string>
#include <utility>

using tactus::sync::xml_reason;

TEST_CASE("A text that is not XML has a reason and a remedy, and no code of the library") {
  const std::string deep = [] {
    std::string text;
    for (int i = 0; i < 2000; ++i) text += "<a>";
    return text;
  }();
  const std::pair<std::string, std::string> cases[] = {
      {"", "it is empty"},
      {"<a></b>", "closed by another name"},
      {"<a><b></a>", "closed by another name"},
      {"<a", "a tag is incomplete"},
      {"<a><b></b>", "ends before its last element is closed"},
      {"<a b=1/>", "an attribute is not NAME=\"VALUE\""},
      {"<a b=\"1\" b=\"2\"/>", "an attribute is not NAME=\"VALUE\""},
      {"<a>text", "its element is not closed"},
      {"<a><![CDATA[x</a>", "a CDATA section does not end"},
      {"<a><!-- x</a>", "a comment does not end"},
      {"<?xml version=\"1.0\"", "the declaration"},
      {"<!DOCTYPE a", "a <! ... > does not end"},
      {deep, "nested too deeply"},
      {"only words", "outside of an element"},
  };
  for (const auto& [text, words] : cases) {
    INFO(text.substr(0, 40));
    tinyxml2::XMLDocument document;
    REQUIRE(document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS);
    const std::string reason = xml_reason(document);
    CAPTURE(reason);
    CHECK(reason.find(words) != std::string::npos);
    CHECK(reason.find("; ") != std::string::npos);
    CHECK(reason.find("XML_") == std::string::npos);
  }
}
