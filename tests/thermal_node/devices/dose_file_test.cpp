#include "thermal_node/devices/dose_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "sync/virtual_time/virtual_time.h"
#include "tests/thermal_node/support/device_time.h"

using namespace tactus;
using namespace tactus::thermal;
using tactus::thermal::test::kClock;

namespace {

sync::HostTime at_s(double s) { return sync::host_time(1'000'000'000) + sync::from_seconds(s); }

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_dose_XXXXXX";
    path = mkdtemp(name);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file() const { return path + "/thermal_node.dose"; }
  std::string path;
};

}  // namespace

TEST_CASE("An exposure survives a restart, and recovers until the next start") {
  const Folder folder;
  DoseFile(folder.file(), kClock).save({40, 50, true, false}, at_s(0));
  const auto loaded = [&](double s) { return DoseFile(folder.file(), kClock).load(at_s(s)); };
  const DwellAccount soon = loaded(0.1);
  CHECK(soon.dose_s == Approx(40));
  CHECK(soon.cold_s == Approx(50));
  CHECK(soon.warm_limited);
  CHECK_FALSE(soon.cold_limited);
  const DwellAccount later = loaded(30 + DoseFile::kAhead_s);
  CHECK(later.dose_s == Approx(40 * std::exp(-0.1)));
  CHECK(later.cold_s == Approx(20));
  CHECK(later.warm_limited);
  // By another clock, or by one that has stepped back, no time has passed.
  CHECK(DoseFile(folder.file(), kClock + 1).load(at_s(1e6)).dose_s == Approx(40));
  CHECK(loaded(-100).dose_s == Approx(40));
}

TEST_CASE("No file is created before the first exposure, and without a file there is none") {
  const Folder folder;
  DoseFile file(folder.file(), kClock);
  CHECK(file.load(at_s(0)).dose_s == 0);
  file.save({}, at_s(1));
  CHECK(file.problem().empty());
  CHECK_FALSE(std::filesystem::exists(folder.file()));
  file.save({1e-3, 0, false, false}, at_s(2));
  CHECK(std::filesystem::exists(folder.file()));
  struct stat s {};
  REQUIRE(stat(folder.file().c_str(), &s) == 0);
  CHECK((s.st_mode & 0777) == 0600);
}

TEST_CASE("A growing exposure is written ten times a second, a recovering one is not") {
  const Folder folder;
  DoseFile file(folder.file(), kClock);
  const auto stored = [&] { return DoseFile(folder.file(), kClock).load(at_s(0)).dose_s; };
  file.save({10, 0, false, false}, at_s(0));
  file.save({11, 0, false, false}, at_s(0.05));
  CHECK(stored() == Approx(10));
  file.save({12, 0, false, false}, at_s(0.1));
  CHECK(stored() == Approx(12));
  file.save(DwellAccount{12, 0, false, false}.recovered(100), at_s(100));
  CHECK(stored() == Approx(12));
}

TEST_CASE("A file that cannot be believed counts as a full exposure, and is not written") {
  const Folder folder;
  const auto refused = [&] {
    DoseFile file(folder.file(), kClock);
    Dwell dwell({60, 20, 60});
    dwell.resume(file.load(at_s(0)));
    CHECK(dwell.step(33, 0.02, {15, 42}).max_degC == Dwell::kWarm_degC);
    CHECK(dwell.step(33, 0.02, {15, 42}).min_degC == 20);
    CHECK_FALSE(file.problem().empty());
  };
  SECTION("a link") {
    std::ofstream(folder.path + "/other") << "tactus_dose 1 77 0 0 0 0 0\n";
    chmod((folder.path + "/other").c_str(), 0600);
    std::filesystem::create_symlink(folder.path + "/other", folder.file());
    refused();
  }
  SECTION("a pipe") {
    REQUIRE(mkfifo(folder.file().c_str(), 0600) == 0);
    refused();
  }
  SECTION("writable by others") {
    std::ofstream(folder.file()) << "tactus_dose 1 77 0 0 0 0 0\n";
    chmod(folder.file().c_str(), 0666);
    refused();
  }
  SECTION("a second name") {
    std::ofstream(folder.file()) << "tactus_dose 1 77 0 0 0 0 0\n";
    chmod(folder.file().c_str(), 0600);
    std::filesystem::create_hard_link(folder.file(), folder.path + "/other");
    refused();
  }
  SECTION("damaged") {
    for (const char* text :
         {"nonsense", "tactus_dose 1 77 0 -5 0 0 0", "tactus_dose 1 77 0 nan 0 0 0", "tactus_dose 1 77"}) {
      std::ofstream(folder.file()) << text;
      chmod(folder.file().c_str(), 0600);
      refused();
    }
  }
}

TEST_CASE("A folder that cannot be written is named, once") {
  DoseFile file("/nonexistent/thermal_node.dose", kClock);
  CHECK(file.load(at_s(0)).dose_s == 0);
  file.save({10, 0, false, false}, at_s(0));
  CHECK_THAT(file.problem(), Catch::Contains("choose another --exposure"));
}

TEST_CASE("The default file is in the folder of the program, and virtual time has none") {
  CHECK(default_dose_file("/results", "thermal_node") == "/results/thermal_node.dose");
  sync::VirtualTime time;
  CHECK(default_dose_file("/results", "thermal_node").empty());
  DoseFile none("", kClock);
  none.save({10, 0, false, false}, at_s(0));
  CHECK(none.load(at_s(1)).dose_s == 0);
  CHECK(none.problem().empty());
}
