#include "visual_node/overlay/panel.h"

#include <algorithm>
#include <cstdio>
#include <tactus/histogram_t.hpp>

#include "sync/time/histogram.h"
#include "visual_node/frame/text.h"
#include "visual_node/overlay/keys.h"

namespace tactus::visual {
namespace {

std::string text(const char* format, auto... values) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

double ms(sync::Nanoseconds t) { return sync::to_seconds(t) * 1e3; }

// Text of an age with useful precision.
std::string age(sync::Nanoseconds t) { return text(ms(t) < 100 ? "%.1f ms" : "%.0f ms", ms(t)); }

// Breaks at a blank in the second half of the line, if any; continuation lines are indented.
std::vector<std::string> wrapped(const std::vector<std::string>& lines, std::size_t letters) {
  constexpr std::size_t kIndent = 2;
  std::vector<std::string> out;
  if (letters <= 2 * kIndent) return out;
  for (std::string line : lines) {
    while (line.size() > letters) {
      const std::size_t blank = line.rfind(' ', letters);
      const std::size_t cut = blank != std::string::npos && blank > letters / 2 ? blank : letters;
      out.push_back(line.substr(0, cut));
      line = std::string(kIndent, ' ') + line.substr(cut + (line[cut] == ' '));
    }
    out.push_back(std::move(line));
  }
  return out;
}

float line_step(float size) { return (kGlyphHeight + 3) * size; }

std::size_t letters_in(float width, float size) {
  return static_cast<std::size_t>(std::max(0.0f, (width - 4 * size) / ((kGlyphWidth + 1) * size)));
}

std::size_t lines_in(float height, float size) {
  return static_cast<std::size_t>(std::max(0.0f, (height - 4 * size) / line_step(size)));
}

void append_report(std::vector<std::string>& lines, const PanelData& f) {
  lines.push_back(text("contacts  %zu", f.contacts));
  const auto physics = f.physics.median();
  if (physics && f.physics.nominal_rate_Hz() > 0)
    lines.push_back(text("physics   %.2f of %.2f ms, x%.2f", ms(*physics), 1e3 / f.physics.nominal_rate_Hz(),
                         f.physics.realtime_factor()));
  else
    lines.push_back("physics   no messages");
  // Offline a frame takes no time.
  lines.push_back(f.rendering > sync::Nanoseconds(0)
                      ? text("rendering %.1f of %.1f ms", ms(f.rendering), ms(f.period))
                      : "rendering not measured");
}

void append_ages(std::vector<std::string>& lines, const PanelData& f) {
  for (const InputLine& i : f.inputs) {
    const std::string status = i.status == sync::SampleStatus::kNone ? "" : std::string(" ") + sync::to_string(i.status);
    lines.push_back(i.age.age < sync::Nanoseconds(0) ? i.channel + " nothing yet" + status
                                                     : i.channel + " " + age(i.age.age) + status);
  }
}

void append_degradation(std::vector<std::string>& lines, const PanelData& f) {
  lines.push_back("profile   " + (f.profile.empty() ? "none" : f.profile));
  lines.push_back(text("delay     %.0f ms, profile %.0f ms", ms(f.delay), ms(f.profile_delay)));
  if (const double Hz = f.output.value("frame_rate"); Hz > 0) lines.push_back(text("pictures  %.3g Hz", Hz));
  if (const double x = f.output.value("resolution"); x > 0) lines.push_back(text("resolution x%.2f", x));
  lines.push_back(text("quality   step %d of 0 to %d", f.quality, std::max(0, f.qualities - 1)));
}

}  // namespace

void TickTimes::push(const node_health_t& m) {
  if (newest_ && newest_->header.incarnation == m.header.incarnation && m.header.seq <= newest_->header.seq)
    return;
  if (newest_ && newest_->header.incarnation == m.header.incarnation) {
    histogram_t difference = m.tick;
    for (std::size_t i = 0; i < difference.bins.size() && i < newest_->tick.bins.size(); ++i)
      difference.bins[i] = std::max(0, difference.bins[i] - newest_->tick.bins[i]);
    const sync::Histogram h = sync::Histogram::from_message(difference);
    if (h.count() > 0) median_ = h.quantile(0.5);
  } else {
    median_.reset();
  }
  newest_ = m;
}

std::vector<std::string> panel_lines(const OverlaySet& on, const PanelData& f) {
  std::vector<std::string> lines;
  if (on.on(Overlay::kReport)) append_report(lines, f);
  if (on.on(Overlay::kGroups)) {
    lines.push_back(text("orange    %zu haptic bodies", f.haptic_bodies));
    lines.push_back(text("blue      %zu visual bodies", f.visual_bodies));
  }
  if (on.on(Overlay::kDegradation)) append_degradation(lines, f);
  if (on.on(Overlay::kAges)) append_ages(lines, f);
  if (on.on(Overlay::kHelp))
    for (const std::string& line : help_lines()) lines.push_back(line);
  return lines;
}

float append_lines(std::vector<Rect>& overlay, const std::vector<std::string>& lines, const TextArea& room,
                   float largest, const TextLook& look) {
  float size = std::max(1.0f, largest);
  std::vector<std::string> all = wrapped(lines, letters_in(room.right - room.x, size));
  while (size > 1 && all.size() > lines_in(room.bottom - room.y, size)) {
    size -= 1;
    all = wrapped(lines, letters_in(room.right - room.x, size));
  }
  all.resize(std::min(all.size(), lines_in(room.bottom - room.y, size)));
  std::size_t longest = 0;
  for (const std::string& line : all) longest = std::max(longest, line.size());
  if (longest == 0) return room.y;
  const float height = line_step(size) * static_cast<float>(all.size()) + 3 * size;
  append_plate(overlay, look.panel, room.x, room.y, text_width(longest, size), height);
  for (std::size_t i = 0; i < all.size(); ++i)
    append_letters(overlay, all[i], room.x + 2 * size, room.y + 2 * size + line_step(size) * static_cast<float>(i),
                   size, look.words);
  return room.y + height + 2 * size;
}

float text_size(int picture_height, const TextLook& look) {
  return look.scaled(static_cast<float>(std::max(1, picture_height / 240)));
}

}  // namespace tactus::visual
