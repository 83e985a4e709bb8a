#include "thermal_node/skin/tissue.h"

namespace tactus::thermal {
namespace {

// Conductivity and specific heat of epidermis and dermis, specific heat of fat: porcine, in vitro; conductivity of
// fat: human; all from doi 10.1016/j.burns.2016.11.014, table 3. Density of skin, and all of muscle and bone: doi
// 10.3390/cancers11081183, table 1 (from the IT'IS database). Density of fat: the IT'IS database, not verified
// again.
//
// Thickness: the horny layer of a finger pad is 0.3 mm (Adams et al. 2013, J. R. Soc. Interface 10, 20120467,
// figure 1), the living epidermis adds about 0.1 mm (design); dermis 1 mm, pulp 3.5 mm, half of the bone 3 mm, and
// of the palm fat 3 mm and muscle 10 mm (design: the depths of an adult hand; the first seconds of a touch reach 1
// to 2 mm).
constexpr Layer kEpidermis{0.4e-3, 0.21, 1125, 3600, false};
constexpr Layer kDermis{1.0e-3, 0.37, 1125, 3224, true};
constexpr Layer kPulp{3.5e-3, 0.20, 911, 2303, true};
constexpr Layer kHalfBone{3.0e-3, 0.40, 1990, 1300, false};
constexpr Layer kPalmFat{3.0e-3, 0.20, 911, 2303, true};
constexpr Layer kMuscle{10e-3, 0.56, 1050, 3639, true};

}  // namespace

std::vector<Layer> layers_of(const std::string& site) {
  if (site == "finger") return {kEpidermis, kDermis, kPulp, kHalfBone};
  if (site == "palm") return {kEpidermis, kDermis, kPalmFat, kMuscle};
  return {};
}

}  // namespace tactus::thermal
