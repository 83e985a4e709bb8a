#include "haptic_node/devices/motion_file.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "haptic_node/devices/playback.h"
#include "haptic_node/devices/spidar/frame_file.h"

using namespace tactus;
using namespace tactus::haptic;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

Motion read(const std::string& text) {
  std::istringstream in(text);
  return read_motion(in, "stroke.csv");
}
sync::HostTime at_s(double s) { return sync::host_time(7) + sync::from_seconds(s); }

}  // namespace

TEST_CASE("A motion file is read with or without orientation") {
  const Motion plain = read("time_s,x_m,y_m,z_m\n0,1,2,3\r\n0.5,4,5,6\n");
  REQUIRE(plain.times_s.size() == 2);
  CHECK(plain.positions_m[1] == Vector3d(4, 5, 6));
  const Motion posed = read("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,-0.8,0,0,-0.6\n");
  CHECK(posed.orientations[1].w() == Approx(0.8));  // in the same half space as its neighbour
}

TEST_CASE("An error in a motion file is reported with its line") {
  CHECK_THROWS_WITH(read(""), Contains("stroke.csv, line 1") && Contains("time_s,x_m,y_m,z_m"));
  CHECK_THROWS_WITH(read("t,x,y,z\n"), Contains("line 1"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n"), Contains("no row"));
  CHECK_THROWS_WITH(read(std::string("time_s,x_m,y_m,z_m\n0,0,0,1\0 2\n", 30)), Contains("line 2") && Contains("byte 0"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n0,0,0,0\n1,0,zero,0\n"), Contains("line 3") && Contains("\"zero\""));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n0,0,0\n"), Contains("line 2") && Contains("3 columns"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n0,0,0,nan\n"), Contains("line 2"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n1,0,0,0\n1,0,0,0\n"),
                    Contains("line 3") && Contains("does not increase"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,2,0,0,0\n"), Contains("unit length"));
  CHECK_THROWS_WITH(read_motion("/no/such/file.csv"), Contains("/no/such/file.csv") && Contains("cannot be read"));
}

TEST_CASE("A motion file must be a regular file of limited size and line length") {
  for (const char* path : {"/dev/zero", "/dev/null", "/"})
    CHECK_THROWS_WITH(read_motion(path), Contains(path) && Contains("not a regular file"));
  CHECK_THROWS_WITH(read(std::string(1001, 't')), Contains("line 1") && Contains("longer than 1000"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n0,0,0,0" + std::string(1000, '0') + "\n"),
                    Contains("line 2") && Contains("longer than 1000"));
  CHECK_THROWS_WITH(read("time_s,x_m,y_m,z_m\n0,0,0,0\n" + std::string(std::size_t{64} << 20, '\n')),
                    Contains("64 MiB"));
  CHECK(read("time_s,x_m,y_m,z_m\n\n0,0,0,1\n\n1,0,0,2").times_s.size() == 2);
  CHECK(read("time_s,x_m,y_m,z_m\n0,0,0,1." + std::string(900, '0') + "\n").positions_m[0].z() == 1);
}

TEST_CASE("A motion file or a string frame that is a pipe is refused at once") {
  std::string folder = (std::filesystem::temp_directory_path() / "tactus_XXXXXX").string();
  REQUIRE(mkdtemp(folder.data()));
  const std::string pipe = folder + "/pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_motion(pipe), Contains(pipe) && Contains("not a regular file"));
  CHECK_THROWS_WITH(read_frame(pipe), Contains(pipe) && Contains("not a regular file"));
  std::filesystem::remove_all(folder);
}

TEST_CASE("A motion of too many rows is rejected, and one that is cut off or damaged is a motion or one sentence") {
  std::string rows = "time_s,x_m,y_m,z_m\n";
  for (int i = 0; i <= 2'000'000; ++i) rows += std::to_string(i) + "e-3,0,0,0\n";
  CHECK_THROWS_WITH(read(rows), Contains("line 2000002") && Contains("more than 2000000 rows"));
  const std::string whole = "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0.1,-2e-3,0,1,0,0,0\n0.5,1,2,3,0.8,0,0,0.6\n";
  std::mt19937 random(4);
  const auto check = [](const std::string& text) {
    try {
      const Motion motion = read(text);
      for (std::size_t i = 0; i < motion.times_s.size(); ++i)
        REQUIRE((std::isfinite(motion.times_s[i]) && motion.positions_m[i].allFinite() && motion.orientations[i].coeffs().allFinite()));
    } catch (const std::runtime_error& e) {
      REQUIRE(std::string(e.what()).find('\n') == std::string::npos);
    }
  };
  for (std::size_t size = 0; size < whole.size(); ++size) check(whole.substr(0, size));
  const std::string pieces[] = {"nan", "inf", "-1e999", ",,", "\n", "0x1p9", "-"};
  for (int i = 0; i < 5000; ++i) {
    std::string changed = whole;
    for (int k = 0; k <= i % 3; ++k) {
      const std::size_t at = random() % changed.size();
      if (random() % 2 == 0)
        changed[at] = static_cast<char>(random());
      else
        changed.replace(at, random() % 5, pieces[random() % std::size(pieces)]);
    }
    check(changed);
  }
}

TEST_CASE("A playback passes every sample with its scale, offset and rate, and rests at the last sample") {
  const Motion motion = read("time_s,x_m,y_m,z_m\n10,0,0,0\n10.1,0.1,0,0\n10.2,0.2,0,0\n10.4,0.2,0.3,0\n");
  Playback device(motion, Placement{2, {1, 0, 0}, 0.5});
  CHECK(device.read(at_s(-3)).position == Vector3d(1, 0, 0));
  CHECK(device.read(at_s(-1)).velocity.norm() == 0);
  device.begin(at_s(0));
  CHECK(device.read(at_s(0)).position == Vector3d(1, 0, 0));
  CHECK((device.read(at_s(0.2)).position - Vector3d(1.2, 0, 0)).norm() < 1e-12);
  CHECK((device.read(at_s(0.1)).position - Vector3d(1.1, 0, 0)).norm() < 1e-12);
  CHECK((device.read(at_s(0.1)).velocity - Vector3d(1, 0, 0)).norm() < 1e-9);  // 1 m/s * 2 * 0.5
  device.write({0, 0, 100});
  CHECK((device.read(at_s(0.8)).position - Vector3d(1.4, 0.6, 0)).norm() < 1e-12);
  CHECK((device.read(at_s(9)).position - Vector3d(1.4, 0.6, 0)).norm() < 1e-12);
  CHECK(device.read(at_s(9)).velocity.norm() == 0);
}

TEST_CASE("A playback rotates uniformly between two orientations") {
  Playback device(read("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,0.7071068,0,0,0.7071068\n"), {});
  device.begin(at_s(0));
  const Eigen::AngleAxisd half(device.read(at_s(0.5)).orientation);
  CHECK(half.angle() == Approx(M_PI / 4).epsilon(1e-6));
}

TEST_CASE("A playback reproduces recorded strokes") {
  const char* data = std::getenv("TACTUS_DATA");
  if (!data) {
    WARN("TACTUS_DATA is not set: recorded strokes are not played");
    return;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "tool_motion")) {
    if (entry.path().extension() != ".csv") continue;
    ++files;
    const Motion motion = read_motion(entry.path().string());
    REQUIRE(motion.times_s.size() > 100);
    Playback device(motion, {});
    device.begin(at_s(0));
    double worst = 0;
    for (std::size_t i = 0; i < motion.times_s.size(); ++i) {
      const DeviceState state = device.read(at_s(motion.times_s[i] - motion.times_s[0]));
      // Times are rounded down to a nanosecond: at 10 m/s that is 10 nm.
      worst = std::max(worst, (state.position - motion.positions_m[i]).norm());
    }
    CHECK(worst < 1e-8);
  }
  CHECK(files > 0);
}
