#include "scripts/experiments/paradigms.h"

#include <stdexcept>

namespace tactus::experiments {
namespace {

// Properties that pointing.cpp of the observer uses.
#define TACTUS_AIMED                                                                                              \
  "visual latency", "touch latency", "muscle time constant", "error of the believed delay", "adaptation rate",    \
      "motor adaptation", "visual noise", "proprioceptive noise", "proprioceptive bias", "assumed process noise", \
      "motor noise, share", "motor noise, constant", "effective mass", "pace", "caution", "wait threshold",       \
      "lapse"
#define TACTUS_ARM "arm stiffness", "rise of stiffness with load", "damping ratio"

}  // namespace

const std::vector<Paradigm>& paradigms() {
  static const std::vector<Paradigm> all{
      {"two_events",
       "the time of two events: together or not, which was first, or in which of two intervals they were apart",
       two_events,
       {"onset noise of touch", "onset noise of sight", "onset noise of hearing",
        "error of the believed latency of touch", "error of the believed latency of hearing",
        "error of the believed delay", "proprioceptive noise", "prior of a common cause", "lapse"}},
      {"pointing", "an aimed movement with a late picture", pointing, {TACTUS_AIMED}},
      {"tapping",
       "an aimed movement to a plate, with a late picture and a late force",
       tapping,
       {TACTUS_AIMED, TACTUS_ARM, "force floor"}},
      {"joint_carry",
       "two people bring one object to a place; picture and force of the partner are late",
       joint_carry,
       {TACTUS_AIMED, TACTUS_ARM, "force floor", "force Weber"}},
      {"pursuit",
       "a body follows a target through a late and reduced connection",
       pursuit,
       {TACTUS_AIMED, TACTUS_ARM}},
      {"stroke",
       "two strokes through a damper, a spring or a mass, one with a late force",
       stroke,
       {TACTUS_ARM, "effective mass", "force Weber", "force floor", "proprioceptive noise", "motor noise, share",
        "onset noise of touch", "lapse"}},
      {"press_spring",
       "the stiffness of two pressed springs, one with a late force or picture",
       press_spring,
       {TACTUS_ARM, "effective mass", "stiffness Weber", "visual noise", "proprioceptive noise", "lapse"}},
      {"deadband",
       "two presses, one with a force that is sent only when it changes by a share",
       deadband,
       {TACTUS_ARM, "effective mass", "force Weber", "motor noise, constant", "muscle time constant", "lapse"}},
      {"bar_size",
       "the height of two bars that are seen, felt, or both",
       bar_size,
       {"visual noise", "proprioceptive noise", "lapse"}},
      {"impact_material",
       "wood, plastic or metal by the sound and the vibration of an impact",
       impact_material,
       {"onset noise of touch", "onset noise of hearing", "lapse"}},
      {"contact_cooling",
       "which of two materials cools the finger more",
       contact_cooling,
       {"thermal Weber", "lapse"}},
  };
  return all;
}

#undef TACTUS_AIMED
#undef TACTUS_ARM

Outcome run_trial(const std::string& paradigm, Participant& participant, const TrialSettings& settings,
                  std::uint64_t number) {
  for (const Paradigm& one : paradigms()) {
    if (paradigm != one.name) continue;
    Outcome outcome = one.run(participant, settings, number);
    settings.require_all_used();
    return outcome;
  }
  std::string all;
  for (const Paradigm& one : paradigms()) all += (all.empty() ? "" : ", ") + std::string(one.name);
  throw std::invalid_argument("there is no paradigm " + paradigm + "; choose from " + all);
}

}  // namespace tactus::experiments
