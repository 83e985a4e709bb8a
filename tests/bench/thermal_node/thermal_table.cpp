// Accuracy of warmth: ten materials against finite differences and against measurements on people; their rendering by a display, compared
// with a passive plate; and the pairs that a person can discriminate by published thresholds, before and after the display.
//
//    bin/thermal_table [--json FILE]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sync/node/node_options.h"
#include "tests/bench/thermal_node/thermal_display.h"
#include "tests/thermal_node/support/finite_differences.h"

using namespace tactus::thermal;
using namespace tactus::thermal::bench;
using nlohmann::json;

namespace {

const std::vector<std::string> kMaterials{"copper", "aluminium", "steel", "granite", "concrete",
                                    "glass",  "abs",       "oak",   "rubber",  "foam"};
const double kTimes_s[] = {0.1, 1, 10};

// From sim_node/scenes/materials.csv, whose numbers come before every quoted text.
std::vector<Material> materials() {
  std::ifstream file(TACTUS_SOURCE_DIR "/sim_node/scenes/materials.csv");
  std::vector<Material> found;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; row.size() < 12 && std::getline(cells, cell, ',');) row.push_back(cell);
    if (row.size() == 12 && std::find(kMaterials.begin(), kMaterials.end(), row[0]) != kMaterials.end())
      found.push_back({row[0], std::stod(row[9]), std::stod(row[3]), std::stod(row[10]), std::stod(row[11])});
  }
  std::sort(found.begin(), found.end(),
            [](const Material& a, const Material& b) { return a.effusivity_() > b.effusivity_(); });
  if (found.size() != kMaterials.size()) throw std::runtime_error("sim_node/scenes/materials.csv lacks one of the ten");
  return found;
}

oracle::Slab semi_infinite(double k, double c) { return {20 * std::sqrt(k / c * 10), k, c}; }

oracle::FiniteDifferences reference_of(const Material& m, const std::string& model) {
  const double h = contact_conductance_W_m2K(m.conductivity_W_mK);
  oracle::Touch touch{{}, semi_infinite(m.conductivity_W_mK, m.heat_capacity()), h};
  if (model == "half_space") {
    oracle::Slab tissue = semi_infinite(0.37, 3.77e6);
    tissue.blood_W_m3K = 0.0025 * 3.77e6;
    touch.skin = {tissue};
    return oracle::FiniteDifferences(touch);
  }
  const BioheatModel resting({layers_of("finger"), 33, 23, 0.0025, 8});
  for (const Layer& l : layers_of("finger"))
    touch.skin.push_back({l.thickness_m, l.conductivity_W_mK, l.density_kg_m3 * l.specific_heat_J_kgK,
                          l.perfused ? 0.0025 * kBloodHeatCapacity_J_m3K : 0});
  touch.blood_degC = resting.blood_degC();
  oracle::Touch bare = touch;
  bare.skin_air_W_m2K = 8;
  oracle::FiniteDifferences rest(bare), reference(touch);
  rest.begin_at_rest();
  reference.begin_like(rest);
  return reference;
}

json against_oracle(const std::vector<Material>& ten) {
  std::puts(
      "\nChange of skin temperature after 0.1, 1 and 10 s at 1 N on 1 cm^2, skin 33 degC, thing 23 degC, K; and "
      "the largest\n"
      "difference from finite differences, mK\n");
  std::puts("             half_space                     off | bioheat, finger                off");
  json rows;
  double worst_K = 0;
  for (const Material& m : ten) {
    std::printf("  %-10s", m.name.c_str());
    json row{{"material", m.name}, {"effusivity", m.effusivity_()}};
    for (const std::string model : {"half_space", "bioheat"}) {
      auto reference = reference_of(m, model);
      const Trace trace = touching(m, model, 10);
      double off_K = 0;
      for (const double t : kTimes_s) {
        reference.advance(t);
        const double degC = trace[static_cast<std::size_t>(std::lround(t / 0.02))];
        off_K = std::max(off_K, std::abs(degC - reference.surface_degC()));
        std::printf(" %7.2f", degC - 33);
        row[model]["change_K"].push_back(degC - 33);
        row[model]["oracle_K"].push_back(reference.surface_degC() - 33);
      }
      std::printf("    %4.1f %s", 1000 * off_K, model == "half_space" ? "|" : "\n");
      worst_K = std::max(worst_K, off_K);
    }
    rows.push_back(row);
  }
  std::printf("\n  worst of all: %.1f mK (bound: 10)\n", 1000 * worst_K);
  return {{"rows", rows}, {"worst_K", worst_K}};
}

// Measurements on people, as far as the text could be obtained: Jones 2009 (Scholarpedia 4(5):7955, citing Ho and Jones 2006).
json against_people(const std::vector<Material>& ten) {
  std::puts(
      "\nAgainst what was measured (Jones 2009, citing Ho and Jones 2006): after 10 s of contact at room "
      "temperature skin falls by\n"
      "\"as much as\" 5 K on copper, by less than 2 K on plastic. The models, by how firmly the finger presses, "
      "K\n");
  std::puts("               half_space: 1 kPa    4 kPa   10 kPa | bioheat: 1 kPa    4 kPa   10 kPa   measured");
  json rows;
  for (const auto& [name, measured_K] : {std::pair<std::string, double>{"copper", -5}, {"abs", -2}}) {
    const Material& m = *std::find_if(ten.begin(), ten.end(), [&](const Material& x) { return x.name == name; });
    std::printf("  %-10s", name.c_str());
    json row{{"material", name}, {"measured_K", measured_K}};
    for (const std::string model : {"half_space", "bioheat"}) {
      std::printf("%s", model == "half_space" ? "           " : " |        ");
      for (const double kPa : {1.0, 4.0, 10.0}) {
        const auto skin = skin_of(model);
        skin->set_object(m.object());
        skin->step(10, contact_conductance_W_m2K(m.conductivity_W_mK) * contact_share(kPa * 0.1, 1e-4, Press{}),
                   1);
        std::printf(" %8.2f", skin->surface_degC() - 33);
        row[model].push_back({{"kPa", kPa}, {"change_K", skin->surface_degC() - 33}});
      }
    }
    std::printf(" %8s %.0f\n", name == "copper" ? "to" : "above", measured_K);
    rows.push_back(row);
  }
  std::puts(
      "\n  At 10 kPa, where the contact resistance of Ho and Jones 2008 holds, both models cool more than was\n"
      "  measured; a light touch of 1 kPa is near it. The force, the skin and the room of that experiment could "
      "not be\n"
      "  read; the change is in proportion to the difference of skin and room. Ho and Jones 2008 themselves find "
      "their\n"
      "  model less than 1 K off above 4 kPa.");
  return rows;
}

double rms_K(const Trace& a, const Trace& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]) / static_cast<double>(a.size());
  return std::sqrt(sum);
}

// Time until nine tenths of the final change of the real touch are reached; -1: never.
double time_to_90_s(const Trace& trace, double end_K) {
  for (std::size_t i = 0; i < trace.size(); ++i)
    if (std::abs(trace[i] - 33) >= 0.9 * std::abs(end_K)) return 0.02 * static_cast<double>(i);
  return -1;
}

struct Shown {
  Material material;
  Trace real, flux, skin, passive;
};

json displayed(const std::vector<Material>& ten, const std::string& model, const std::string& person,
               std::vector<Shown>* keep) {
  std::printf(
      "\nThe first 5 s on the display, rendered with %s for a finger that is %s: rms error of its skin, K, and "
      "time to 90 %% of\n"
      "the change, s\n\n",
      model.c_str(), person.c_str());
  std::puts(
      "              change   rms: passive    display=skin   display=flux   after 1 s | time to 90 %: real   "
      "flux");
  json rows;
  for (const Material& m : ten) {
    const Trace real = touching(m, person, 5);
    const Trace flux = display(m, model, person, Drive::kFlux, 5),
                skin = display(m, model, person, Drive::kSkin, 5),
                passive = display(m, model, person, Drive::kPassive, 5);
    const double end_K = real.back() - 33;
    const Trace real_late(real.begin() + 50, real.end()), flux_late(flux.begin() + 50, flux.end());
    const json row{{"material", m.name},
                   {"change_K", end_K},
                   {"rms_passive_K", rms_K(passive, real)},
                   {"rms_skin_K", rms_K(skin, real)},
                   {"rms_flux_K", rms_K(flux, real)},
                   {"rms_flux_after_1_s_K", rms_K(flux_late, real_late)},
                   {"t90_real_s", time_to_90_s(real, end_K)},
                   {"t90_flux_s", time_to_90_s(flux, end_K)}};
    std::printf("  %-10s %7.2f %14.3f %15.3f %14.3f %11.3f | %18.2f %6.2f\n", m.name.c_str(), end_K,
                row["rms_passive_K"].get<double>(), row["rms_skin_K"].get<double>(),
                row["rms_flux_K"].get<double>(), row["rms_flux_after_1_s_K"].get<double>(),
                row["t90_real_s"].get<double>(), row["t90_flux_s"].get<double>());
    rows.push_back(row);
    if (keep) keep->push_back({m, real, flux, skin, passive});
  }
  return rows;
}

// Bergmann Tiest and Kappers 2009: of two stimuli that extract heat at different rates, the faster is identified from a difference of 43 %
// on.
constexpr double kWeberOfRate = 0.43;

double rate_K_s(const Trace& t) { return 33 - t[50]; }  // mean of the first second

json distinguishable_pairs(const std::vector<Shown>& shown) {
  std::puts(
      "\nPairs that a person could tell apart, by cooling that differs by 43 % or more in the first second "
      "(Bergmann Tiest and Kappers\n"
      "2009): + before the display and after, - neither, lost: only before, gained: only after\n");
  const auto differ = [](double a, double b) {
    const double low = std::min(std::abs(a), std::abs(b)), high = std::max(std::abs(a), std::abs(b));
    return high - low >= kWeberOfRate * low;
  };
  json result{{"lost", json::array()}, {"gained", json::array()}};
  int before = 0, after = 0, pairs = 0;
  std::printf("  %-10s", "");
  for (const Shown& s : shown) std::printf(" %6.6s", s.material.name.c_str());
  std::puts("");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::printf("  %-10s", shown[i].material.name.c_str());
    for (std::size_t j = 0; j < shown.size(); ++j) {
      if (j <= i) {
        std::printf(" %6s", "");
        continue;
      }
      const bool real = differ(rate_K_s(shown[i].real), rate_K_s(shown[j].real));
      const bool flux = differ(rate_K_s(shown[i].flux), rate_K_s(shown[j].flux));
      std::printf(" %6s", real && flux ? "+" : real ? "lost" : flux ? "gained" : "-");
      if (real && !flux) result["lost"].push_back({shown[i].material.name, shown[j].material.name});
      if (!real && flux) result["gained"].push_back({shown[i].material.name, shown[j].material.name});
      before += real, after += flux, ++pairs;
    }
    std::puts("");
  }
  std::printf("\n  %d of %d pairs before, %d after the display; a passive plate: none\n", before, pairs, after);
  result["pairs"] = pairs, result["before"] = before, result["after"] = after;
  return result;
}

// Cost of a tick of 20 ms: a touch rendered with both models of skin, of the touched body and of the finger.
json costs(const Material& m) {
  std::puts("\nA tick of 20 ms, us: median and p99 of 5000\n");
  json result;
  for (const std::string model : {"half_space", "bioheat"}) {
    Hand hand({material(m.conductivity_W_mK, m.density_kg_m3, m.specific_heat_J_kgK, m.degC)},
              with_model(model.c_str()));
    std::vector<double> us;
    for (int i = 0; i < 5000; ++i) {
      Tick tick = hand.next();
      tactus::thermal::touch(tick, 0, 1);
      const auto begin = std::chrono::steady_clock::now();
      hand.renderer.step(tick);
      us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    }
    std::sort(us.begin(), us.end());
    std::printf("  %-10s %6.1f %6.1f\n", model.c_str(), us[us.size() / 2], us[us.size() * 99 / 100]);
    result[model] = {{"p50_us", us[us.size() / 2]}, {"p99_us", us[us.size() * 99 / 100]}};
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) try {
  tactus::sync::Arguments app{"Accuracy of the rendered temperature, against closed forms."};
  std::string file;
  app.add_option("--json", file, "the figures and the traces");
  tactus::sync::parse_or_exit(app, "thermal_table", argc, argv);
  const std::vector<Material> ten = materials();
  json out;
  out["against_oracle"] = against_oracle(ten);
  out["against_people"] = against_people(ten);
  std::vector<Shown> shown;
  out["display"]["half_space"] = displayed(ten, "half_space", "half_space", nullptr);
  out["display"]["bioheat"] = displayed(ten, "bioheat", "bioheat", &shown);
  out["display"]["half_space_for_bioheat"] = displayed(ten, "half_space", "bioheat", nullptr);
  out["told_apart"] = distinguishable_pairs(shown);
  out["tick"] = costs(ten.front());
  for (const Shown& s : shown)
    out["traces"][s.material.name] = {
        {"real", s.real}, {"flux", s.flux}, {"skin", s.skin}, {"passive", s.passive}};
  if (!file.empty()) std::ofstream(file) << out.dump() << "\n";
  return out["against_oracle"]["worst_K"].get<double>() <= 0.01 ? 0 : 1;
} catch (const std::exception& e) {
  std::cerr << "thermal_table: " << e.what() << "\n";
  return 1;
}
