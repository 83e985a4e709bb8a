#include "sync/relay/rules.h"

#include <tinyxml2.h>

#include <algorithm>
#include <stdexcept>

#include "lcmtypes/channels.h"
#include "lcmtypes/spelling_suggestions.h"
#include "sync/relay/motion_line.h"
#include "sync/text/xml_reason.h"

namespace tactus::sync {
namespace {

using Names = std::vector<std::string>;

// All channels of the bus: LOG_INFO exists in logs only.
const Names& channels_of_the_bus() {
  using namespace channels;
  static const Names names{
      kTouchModel,    kContactEvents, kContacts,     kWorldState,     kToolState,   kDeviceState, kDeviceForce,
      kThermalState,  kThermalDevice, kPresented,    kNodeHealth,     kSyncReport,  kClockProbe,  kClockMap,
      kMediaClock,    kFrameShown,    kPlayout,      kPlayoutRequest, kDegradation, kDegraded,    kSimCommand,
      kSimReply,      kSetting,       kSettingReply, kQuestion,    kAnswer,       kTagRequest,     kTagList,     kTagValues,   kGameState,
      kSceneManifest, kAssetRequest,  kAssetChunk,   kPictureChunk};
  return names;
}

// Channels with complete states: the next message replaces one that was left out.
const Names kStates{channels::kTouchModel,   channels::kContacts,      channels::kWorldState,
                    channels::kToolState,    channels::kDeviceState,   channels::kDeviceForce,
                    channels::kThermalState, channels::kThermalDevice, channels::kNodeHealth,
                    channels::kMediaClock,   channels::kFrameShown,    channels::kGameState};
// Channels with known signals (sync/degradation/snapshot.h).
const Names kCompared{channels::kTouchModel, channels::kContacts, channels::kWorldState, channels::kToolState};

bool holds(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string list(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool truth(const std::string& value) {
  if (value != "true" && value != "false")
    throw std::invalid_argument("first=\"" + value + "\" is neither true nor false");
  return value == "true";
}

PassRule parse_pass(const tinyxml2::XMLElement& e) {
  PassRule rule;
  Names given;
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name(), value = a->Value();
    if (holds(given, name)) throw std::invalid_argument(name + " is given twice; remove one");
    given.push_back(name);
    if (name == "channel")
      rule.channel = value;
    else if (name == "first")
      rule.first = truth(value);
    else if (name == "rate" || name == "deadband")
      parse_operator(rule.thinning, name, value);
    else
      throw std::invalid_argument("a <pass> has no " + name + "; it has channel, first, rate and deadband");
  }
  const Names& known = channels_of_the_bus();
  if (rule.channel.empty())
    throw std::invalid_argument("a <pass> needs a channel, for example channel=\"CONTACT_EVENTS\"");
  if (!holds(known, rule.channel)) {
    const std::string near = spelling_suggestions(rule.channel, known);
    throw std::invalid_argument("there is no channel " + rule.channel +
                                (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  if (rule.thinning.rate && !holds(kStates, rule.channel))
    throw std::invalid_argument(
        rule.channel +
        " contains each item once, so a rate would lose some; pass all of it, or none (a rate have " +
        list(kStates) + ")");
  if (rule.thinning.deadband && !holds(kCompared, rule.channel))
    throw std::invalid_argument("a deadband cannot compare messages of " + rule.channel + "; it can compare " +
                                list(kCompared));
  if (rule.thinning.deadband && rule.thinning.deadband->predictor == Predictor::kLinear && !carries_motion(rule))
    throw std::invalid_argument(
        "predict=linear needs a receiver that predicts: give the channel TOOL_STATE, a deadband of velocity or position, and resend=, for "
        "example resend=20ms, after twice of which a silent hand stops; or remove predict=linear");
  if (carries_motion(rule) && rule.thinning.deadband->resend_s > kMaxMotionResend_s)
    throw std::invalid_argument(
        "resend= of a hand is longer than a second: behind a broken line the hand would move on for twice that time; give at most 1s");
  return rule;
}

// An element may contain only elements and comments.
void refuse_text_in(const tinyxml2::XMLNode& within, const char* message, int& line) {
  for (const tinyxml2::XMLNode* n = within.FirstChild(); n; n = n->NextSibling()) {
    if (n->ToElement() || n->ToComment() || (n->ToDeclaration() && within.ToDocument())) continue;
    line = n->GetLineNum();
    throw std::invalid_argument(message);
  }
}

}  // namespace

const PassRule* RelayRules::find(std::string_view channel) const {
  const auto at =
      std::find_if(rules_.begin(), rules_.end(), [&](const PassRule& r) { return r.channel == channel; });
  return at == rules_.end() ? nullptr : &*at;
}

RelayRules parse_relay_rules(const std::string& xml, const std::string& file) {
  int line = 1;
  try {
    // XML allows no NUL; the parser would silently ignore all text after it.
    if (const std::size_t nul = xml.find('\0'); nul != std::string::npos) {
      line = 1 + static_cast<int>(std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(nul), '\n'));
      throw std::invalid_argument("there is a NUL byte here, so this is not text");
    }
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
      line = std::max(1, document.ErrorLineNum());
      throw std::invalid_argument("this is not XML: " + xml_reason(document));
    }
    const tinyxml2::XMLElement* root = document.RootElement();
    if (!root || std::string(root->Name()) != "relay") {
      line = root ? root->GetLineNum() : 1;
      throw std::invalid_argument("rules of a relay begin with <relay>");
    }
    line = root->GetLineNum();
    if (root->FirstAttribute())
      throw std::invalid_argument(std::string("<relay> has no ") + root->FirstAttribute()->Name());
    if (root->NextSiblingElement()) throw std::invalid_argument("a file holds one <relay>");
    refuse_text_in(document, "only comments are valid outside <relay>", line);
    refuse_text_in(*root, "<relay> contains only <pass .../> and comments", line);
    std::vector<PassRule> rules;
    for (const tinyxml2::XMLElement* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
      line = e->GetLineNum();
      if (std::string(e->Name()) != "pass")
        throw std::invalid_argument(std::string("<relay> holds no <") + e->Name() + ">; it holds <pass .../>");
      if (e->FirstChild()) throw std::invalid_argument("a <pass> has no content; end it with />");
      rules.push_back(parse_pass(*e));
      rules.back().line = line;
      for (std::size_t i = 0; i + 1 < rules.size(); ++i)
        if (rules[i].channel == rules.back().channel)
          throw std::invalid_argument(rules.back().channel + " passes by line " + std::to_string(rules[i].line) +
                                      " already; remove one");
    }
    if (rules.empty())
      throw std::invalid_argument(
          "these rules pass no channel; name one, for example <pass channel=\"CONTACT_EVENTS\"/>");
    return RelayRules(std::move(rules));
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(file + ":" + std::to_string(line) + ": " + e.what());
  }
}

}  // namespace tactus::sync
