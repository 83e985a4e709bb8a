#include "visual_node/frame/quality_control.h"

#include <cmath>

namespace tactus::visual {
namespace {

constexpr double kCalm_s = 2;  // design: longer than a glance

std::string describe(const Quality& q) {
  const std::string size =
      q.scale < 1 ? "the picture at " + std::to_string(std::lround(100 * q.scale)) + " % of its resolution"
                  : "the whole picture";
  return size + (q.shadow_divisor == 0 ? ", without shadows" : q.shadow_divisor > 1 ? ", coarser shadows" : "");
}

}  // namespace

QualityControl::QualityControl(const Settings& s)
    : pinned_(s.quality == "auto" ? -1 : s.quality[0] - '0'),
      ladder_(steps(), sync::from_seconds(s.render_budget / s.rate_Hz),
              static_cast<int>(std::lround(kCalm_s * s.rate_Hz))) {}

std::string QualityControl::take_change() {
  if (step() == reported_) return "";
  const bool better = step() < reported_;
  reported_ = step();
  const std::string why = pinned_ >= 0 ? "as set" : better ? "there is time to spare" : "drawing takes too long";
  return "quality step " + std::to_string(reported_) + " of 0.." + std::to_string(steps() - 1) + ", " + why + ": " +
         describe(quality());
}

}  // namespace tactus::visual
