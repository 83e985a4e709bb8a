#include <tinyxml2.h>

#include <sstream>
#include <stdexcept>

#include "sync/degradation/profile.h"

namespace tactus::sync {
namespace {

using Element = tinyxml2::XMLElement;
constexpr std::size_t kMaxRules = 64;  // design: a stack that one can still understand

Rule parse_rule(const Element& e) {
  Rule rule;
  rule.line = e.GetLineNum();
  int operators = 0;
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name(), value = a->Value();
    if (name == "modality") {
      rule.modality = value;
    } else if (name == "material") {
      rule.material = value;
    } else if (name == "bodies") {
      std::istringstream two(value);
      std::string rest;
      if (!(two >> rule.body_a >> rule.body_b) || two >> rest)
        throw std::invalid_argument("bodies=\"" + value + "\": name two bodies, with a blank between them");
    } else {
      parse_operator(rule, name, value);
      operators += name != "from" && name != "until" && name != "conceal";
    }
  }
  if (rule.modality.empty())
    throw std::invalid_argument("a <degrade> needs a modality, for example modality=\"audio\"");
  if (operators == 0)
    throw std::invalid_argument("this <degrade> does nothing; give it an operator, for example delay=\"40ms\"");
  if (rule.until_s && *rule.until_s <= rule.from_s) throw std::invalid_argument("until must be after from");
  if (rule.output.dropout_s > 0 && rule.output.dropout_s >= rule.output.dropout_every_s)
    throw std::invalid_argument("a dropout must be shorter than the time between two of them (every=)");
  return rule;
}

[[noreturn]] void refuse(const std::string& file, int line, const std::string& why) {
  throw std::invalid_argument(file + ":" + std::to_string(line) + ": " + why);
}

}  // namespace

Profile parse_profile(const std::string& xml, const std::string& file) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
    refuse(file, document.ErrorLineNum(), std::string("this is no XML (") + document.ErrorName() + ")");
  const Element* root = document.RootElement();
  if (!root || std::string(root->Name()) != "profile")
    refuse(file, root ? root->GetLineNum() : 1, "a profile begins with <profile>");
  Profile profile;
  int line = root->GetLineNum();
  try {
    for (const tinyxml2::XMLAttribute* a = root->FirstAttribute(); a; a = a->Next()) {
      const std::string name = a->Name();
      if (name == "name")
        profile.name = a->Value();
      else if (name != "seed")
        throw std::invalid_argument("<profile> has a name and a seed, no \"" + name + "\"");
      else if (a->QueryUnsigned64Value(&profile.seed) != tinyxml2::XML_SUCCESS)
        throw std::invalid_argument(std::string("seed=\"") + a->Value() + "\" is no whole number");
    }
    for (const Element* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
      line = e->GetLineNum();
      if (std::string(e->Name()) != "degrade")
        throw std::invalid_argument(std::string("<") + e->Name() +
                                    "> is not known in a profile; it holds <degrade>");
      if (e->FirstChildElement()) throw std::invalid_argument("a <degrade> has attributes, no elements within");
      if (profile.rules.size() == kMaxRules) throw std::invalid_argument("a profile has at most 64 <degrade>");
      profile.rules.push_back(parse_rule(*e));
    }
  } catch (const std::invalid_argument& e) {
    refuse(file, line, e.what());
  }
  return profile;
}

}  // namespace tactus::sync
