#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "audio_node/spatial/sofa.h"
#include "sync/sandbox/reader_process.h"

namespace tactus::audio {

std::vector<std::uint8_t> pack(const MeasuredHrtf& measured) {
  sync::Packer to;
  to.put(measured.rate_Hz), to.put(measured.samples);
  std::vector<double> directions;
  for (const Eigen::Vector3d& d : measured.directions) directions.insert(directions.end(), d.data(), d.data() + 3);
  to.put_list(directions), to.put_list(measured.responses), to.put_list(measured.delays);
  return to.take();
}

MeasuredHrtf unpack_hrtf(std::span<const std::uint8_t> bytes) {
  sync::Unpacker from(bytes);
  MeasuredHrtf measured;
  measured.rate_Hz = from.get<double>(), measured.samples = from.get<int>();
  const auto directions = from.get_list<std::vector<double>>();
  for (std::size_t i = 0; i + 3 <= directions.size(); i += 3) measured.directions.emplace_back(directions.data() + i);
  measured.responses = from.get_list<std::vector<float>>();
  measured.delays = from.get_list<std::vector<double>>();
  const std::size_t count = 2 * measured.directions.size();
  const auto finite = [](auto x) { return std::isfinite(x); };
  if (!from.at_end() || !finite(measured.rate_Hz) || measured.rate_Hz <= 0 || measured.samples <= 0 ||
      measured.delays.size() != count ||
      measured.responses.size() != count * static_cast<std::size_t>(measured.samples) ||
      !std::all_of(directions.begin(), directions.end(), finite) ||
      !std::all_of(measured.responses.begin(), measured.responses.end(), finite) ||
      !std::all_of(measured.delays.begin(), measured.delays.end(), finite))
    throw std::runtime_error("its reader returned no valid responses");
  return measured;
}

MeasuredHrtf load_sofa(const std::string& path) {
  std::error_code error;
  const std::string absolute = std::filesystem::absolute(path, error).string();
  std::string why;
  try {
    const sync::ReaderOutput output = sync::run_reader("read_sounds", {"sofa", absolute});
    if (output.failure.empty() && output.records.size() == 1) {
      const sync::Record& record = output.records.front();
      if (record.kind == 'R') return unpack_hrtf(record.content);
      why = sync::text_of(record);
    } else {
      why = "cannot be read: " + (output.failure.empty() ? "its reader returned nothing" : output.failure);
    }
  } catch (const std::runtime_error& e) {
    why = std::string("cannot be read: ") + e.what();
  }
  throw std::runtime_error("the HRTF file " + path + " " + why + "; choose another hrtf_file");
}

}  // namespace tactus::audio
