#include "audio_node/spatial/layout.h"

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "sync/text/csv.h"

namespace tactus::audio {
namespace {

constexpr std::uintmax_t kMaxBytes = 65536;  // design: far more than kMaxChannels rows need

// In the channel order of a WAV file; a custom file gives another order.
const std::map<std::string, std::string>& built_in() {
  static const std::map<std::string, std::string> all{
      {"stereo", "channel,azimuth_deg,elevation_deg\nleft,30,0\nright,-30,0\n"},
      {"quad",
       "channel,azimuth_deg,elevation_deg\nfront left,45,0\nfront right,-45,0\nback left,135,0\n"
       "back right,-135,0\n"},
      // ITU-R BS.775-3, figure 1.
      {"5.1",
       "channel,azimuth_deg,elevation_deg\nleft,30,0\nright,-30,0\ncentre,0,0\nsubwoofer,,\n"
       "left surround,110,0\nright surround,-110,0\n"},
      // The corners of a cube: asin(1 / sqrt(3)) over its middle.
      {"cube",
       "channel,azimuth_deg,elevation_deg\nlower front left,45,-35.2644\nlower front right,-45,-35.2644\n"
       "lower back left,135,-35.2644\nlower back right,-135,-35.2644\nupper front left,45,35.2644\n"
       "upper front right,-45,35.2644\nupper back left,135,35.2644\nupper back right,-135,35.2644\n"}};
  return all;
}

[[noreturn]] void reject(const std::string& name, const std::string& why) {
  throw std::runtime_error("the loudspeaker layout " + name + " " + why +
                           "; choose stereo, quad, 5.1, cube or another layout_file");
}

}  // namespace

Layout parse_layout(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  if (sync::csv_cells(line) != std::vector<std::string>{"channel", "azimuth_deg", "elevation_deg"})
    reject(name, "does not begin in line 1 with channel,azimuth_deg,elevation_deg");
  Layout layout;
  bool any = false;
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> row = sync::csv_cells(line);
    if (row.size() == 1 && sync::is_blank(row)) continue;  // two commas are a channel without a loudspeaker
    const std::string which = "line " + std::to_string(number);
    if (row.size() != 3) reject(name, "needs three columns in " + which);
    if (row[1].empty() && row[2].empty()) {
      layout.push_back(std::nullopt);
      continue;
    }
    const auto azimuth = sync::csv_number(row[1]), elevation = sync::csv_number(row[2]);
    if (!azimuth || !elevation || std::abs(*azimuth) > 360 || std::abs(*elevation) > 90)
      reject(name, "needs an azimuth of -360 to 360 and an elevation of -90 to 90 degrees in " + which);
    const double a = *azimuth * std::numbers::pi / 180, e = *elevation * std::numbers::pi / 180;
    layout.push_back(Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)));
    any = true;
  }
  if (!any) reject(name, "has no loudspeaker");
  if (layout.size() > kMaxChannels) reject(name, "has more than " + std::to_string(kMaxChannels) + " channels");
  return layout;
}

Layout load_layout(const std::string& name_or_path) {
  if (const auto known = built_in().find(name_or_path); known != built_in().end())
    return parse_layout(known->second, name_or_path);
  const auto text = sync::read_small_file(name_or_path, kMaxBytes);
  if (!text) reject(name_or_path, "cannot be read");
  return parse_layout(*text, name_or_path);
}

}  // namespace tactus::audio
