// The kinds of overlays and a set of them. Pure.
#pragma once

#include <array>
#include <bitset>
#include <string_view>

namespace tactus::visual {

enum class Overlay { kContacts, kForces, kTools, kGroups, kAges, kDegradation, kReport, kPlots, kHelp };
// In that order; values of the setting `overlay`.
inline constexpr std::array<std::string_view, 9> kOverlayNames{"contacts",    "forces", "tools", "groups", "ages",
                                                               "degradation", "report", "plots", "help"};

class OverlaySet {
 public:
  bool on(Overlay o) const { return on_[static_cast<std::size_t>(o)]; }
  void set(Overlay o, bool on = true) { on_[static_cast<std::size_t>(o)] = on; }
  void toggle(Overlay o) { on_.flip(static_cast<std::size_t>(o)); }
  bool any() const { return on_.any(); }
  bool operator==(const OverlaySet&) const = default;

 private:
  std::bitset<kOverlayNames.size()> on_;
};

// "contacts report", also with commas; "none", "" or "all". Throws std::invalid_argument with one sentence for any
// other word.
OverlaySet parse_overlays(std::string_view text);

}  // namespace tactus::visual
