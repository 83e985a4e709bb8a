#include "audio_node/samples/database.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "audio_node/samples/recording_reader.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::audio {
namespace {

namespace fs = std::filesystem;

// Maximum size of all recordings in memory (design: half an hour at 48 kHz); further files are left out.
constexpr std::size_t kMaxBytes = std::size_t{350} << 20;
constexpr std::uintmax_t kMaxSizeBytes = 4096;  // of size.txt, which holds one number

// Sorted, so that the same folder gives the same takes on every machine.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    all.push_back(i->path());
  std::sort(all.begin(), all.end());
  return all;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

// "0.5", "0.5_2": the number before the suffix that distinguishes takes.
std::optional<double> positive(const std::string& text) {
  const std::string number = text.substr(0, text.find('_'));
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || end != number.data() + number.size() || !(value > 0) || !(value < 1e3))
    return std::nullopt;
  return value;
}

std::optional<MaterialPair> materials_of(const std::string& folder) {
  const auto dash = folder.find('-');
  if (dash == std::string::npos) return MaterialPair{"", folder};
  const std::string a = folder.substr(0, dash), b = folder.substr(dash + 1);
  if (a.empty() || b.empty() || b.find('-') != std::string::npos) return std::nullopt;
  return pair_of(a, b);
}

// A layer that is weaker by more than 40 dB is not raised further: it contains more noise than sound (design).
constexpr float kMaxGain = 100;

void equalise_levels(Layers& layers, Interaction interaction) {
  const auto loudness = [&](const Layer& layer) {
    float loudest = 0;
    for (const Recording& r : layer.takes)
      loudest = std::max(loudest, interaction == Interaction::kImpact ? r.peak : r.rms);
    return loudest;
  };
  const float fastest = loudness(layers.by_speed.back());
  for (Layer& layer : layers.by_speed) layer.gain = std::min(kMaxGain, fastest / loudness(layer));
}

class Reader {
 public:
  Reader(Database& into, const std::string& folder, double rate_Hz) : into_(into), recordings_(folder, rate_Hz) {}

  void read_materials(const fs::path& folder, double size_m) {
    const auto materials = materials_of(folder.filename().string());
    if (!materials)
      return add_fault(folder, "is not named after a material or a pair of materials; name it MATERIAL or MATERIAL-MATERIAL");
    if (const auto own = size_of(folder)) size_m = *own;
    for (const fs::path& inside : entries(folder)) {
      const auto kind = std::find_if(kInteractions.begin(), kInteractions.end(),
                                     [&](Interaction i) { return name(i) == inside.filename().string(); });
      if (kind != kInteractions.end() && fs::is_directory(inside))
        read_interaction(inside, {*materials, *kind}, size_m);
      else if (inside.filename() != "size.txt")
        add_fault(inside, "is not read; the folders of a pair are impact, scrape and roll");
    }
  }

 private:
  void add_fault(const fs::path& path, const std::string& what) {
    into_.faults.push_back({path.string(), what, true});
  }

  std::optional<double> size_of(const fs::path& folder) {
    std::error_code none;
    if (!fs::exists(folder / "size.txt", none)) return std::nullopt;
    std::string word, more;
    try {
      std::istringstream(sync::read_regular_text(folder / "size.txt", kMaxSizeBytes)) >> word >> more;
    } catch (const std::runtime_error& e) {
      add_fault(folder / "size.txt", std::string("cannot be read (") + e.what() + "); write one number in metres");
      return std::nullopt;
    }
    const auto size = more.empty() || more == "m" ? positive(word) : std::nullopt;
    if (!size) add_fault(folder / "size.txt", "has no size; write one number in metres");
    return size;
  }

  void read_interaction(const fs::path& folder, const Database::Key& key, double size_m) {
    std::map<double, Layer> layers;
    bool any = false;
    for (const fs::path& path : entries(folder)) {
      any = true;
      const std::string ending = lower(path.extension().string());
      const auto speed = positive(path.stem().string());
      if (ending != ".wav" && ending != ".flac") {
        add_fault(path, "is neither WAV nor FLAC; convert it or remove it");
      } else if (std::error_code error; !fs::is_regular_file(path, error)) {
        add_fault(path, "is not a file; remove it");
      } else if (!speed) {
        add_fault(path, "does not begin with a speed in m/s; name it 0.5.wav or 0.5_2.wav, for example");
      } else if (into_.bytes > kMaxBytes) {
        add_fault(path, "is left out: the recordings before it fill 350 MB; remove some");
      } else if (auto take = recordings_.read(path.string(), key.interaction, into_.faults)) {
        into_.bytes += take->samples.size() * sizeof(float);
        layers[*speed].takes.push_back(std::move(*take));
      }
    }
    if (!any) add_fault(folder, "is empty; put recordings into it or remove it");
    if (layers.empty()) return;
    Layers& found = into_.sounds[key];
    if (!found.by_speed.empty())
      return add_fault(folder, "exists twice, with its materials in either order; keep one of the two");
    found.size_m = size_m;
    for (auto& [speed, layer] : layers) {
      if (found.by_speed.size() == static_cast<std::size_t>(kMaxLayers)) {
        add_fault(folder, "has more than " + std::to_string(kMaxLayers) + " speeds; the fastest are left out");
        break;
      }
      layer.speed_m_s = speed;
      found.by_speed.push_back(std::move(layer));
    }
    equalise_levels(found, key.interaction);
  }

  Database& into_;
  RecordingReader recordings_;
};

}  // namespace

MaterialPair pair_of(const std::string& a, const std::string& b) {
  return a < b ? MaterialPair{a, b} : MaterialPair{b, a};
}

const Layers* Database::of(const MaterialPair& materials, Interaction interaction) const {
  const auto i = sounds.find({materials, interaction});
  return i == sounds.end() ? nullptr : &i->second;
}

Database::Found Database::find(const std::string& a, const std::string& b, Interaction interaction) const {
  Found found;
  if (!a.empty() && !b.empty()) found.pair = of(pair_of(a, b), interaction);
  if (found.pair) return found;
  // A material on itself counts as that material alone.
  const auto alone = [&](const std::string& m) -> const Layers* {
    if (m.empty()) return nullptr;
    const Layers* single = of({"", m}, interaction);
    return single ? single : of({m, m}, interaction);
  };
  found.alone = {alone(a), a == b ? nullptr : alone(b)};
  return found;
}

Database read_database(const std::string& folder, double rate_Hz, double size_m) {
  Database database;
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    database.faults.push_back(
        {folder, "is not a folder; choose another one with the setting sounds", true});
    return database;
  }
  Reader reader(database, folder, rate_Hz);
  for (const fs::path& inside : entries(folder))
    if (fs::is_directory(inside, error))
      reader.read_materials(inside, size_m);
    else if (const auto ending = lower(inside.extension().string()); ending == ".wav" || ending == ".flac")
      database.faults.push_back({inside.string(), "is outside the folders of materials; move it into one", true});
  if (database.sounds.empty())
    database.faults.push_back(
        {folder, "has no playable recording; see the README of the default set", true});
  return database;
}

}  // namespace tactus::audio
