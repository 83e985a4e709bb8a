#include "thermal_node/devices/dose_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "sync/virtual_time/virtual_time.h"

namespace tactus::thermal {
namespace {

constexpr std::size_t kBytes = 160;  // of the one line, padded
constexpr double kUs = 1e-6;

struct Stored {
  std::int32_t clock = 0;
  std::int64_t at_ns = 0;
  DwellAccount account;
};

std::int64_t microseconds(double seconds) {
  return static_cast<std::int64_t>(std::ceil(std::min(seconds, 1e6) / kUs));
}

std::optional<Stored> parse(const char* text) {
  Stored s;
  std::int64_t dose_us = -1, cold_us = -1;
  int warm = -1, cold = -1;
  if (std::sscanf(text, "tactus_dose 1 %" SCNd32 " %" SCNd64 " %" SCNd64 " %" SCNd64 " %d %d", &s.clock, &s.at_ns,
                  &dose_us, &cold_us, &warm, &cold) != 6)
    return std::nullopt;
  if (dose_us < 0 || cold_us < 0 || (warm != 0 && warm != 1) || (cold != 0 && cold != 1)) return std::nullopt;
  s.account = {static_cast<double>(dose_us) * kUs, static_cast<double>(cold_us) * kUs, warm == 1, cold == 1};
  return s;
}

}  // namespace

std::string default_dose_file(const std::string& folder, const std::string& name) {
  return sync::VirtualTime::current() ? "" : folder + "/" + name + ".dose";
}

DoseFile::~DoseFile() {
  if (file_ >= 0) close(file_);
}

bool DoseFile::refuse(const std::string& reason) {
  if (file_ >= 0) close(std::exchange(file_, -1));
  refused_ = true;
  problem_ = "the exposure of the skin in " + path_ + " " + reason;
  return false;
}

// A link is not followed, and a pipe is not waited for.
bool DoseFile::open(bool create) {
  if (file_ >= 0) return true;
  if (refused_ || path_.empty()) return false;
  file_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | (create ? O_CREAT : 0), 0600);
  if (file_ < 0 && errno == ENOENT && !create) return false;
  if (file_ < 0)
    return refuse(std::string("cannot be stored (") + std::strerror(errno) + "); choose another --exposure");
  struct stat s {};
  if (fstat(file_, &s) != 0 || !S_ISREG(s.st_mode) || s.st_uid != geteuid() || (s.st_mode & 022) != 0 ||
      s.st_nlink != 1)
    return refuse("is not a file of this user alone; remove it");
  return true;
}

DwellAccount DoseFile::load(sync::HostTime now) {
  if (!open(false)) return refused_ ? DwellAccount::full() : DwellAccount{};
  std::array<char, kBytes + 1> text{};
  const ssize_t size = pread(file_, text.data(), kBytes, 0);
  if (size == 0) return {};  // created, and ended before its first write
  const auto stored = size > 0 ? parse(text.data()) : std::nullopt;
  if (!stored) {
    problem_ = "the exposure of the skin in " + path_ +
               " cannot be read: the limits count as reached; wait, or remove it";
    return DwellAccount::full();
  }
  written_ = stored->account;
  const double passed_s = sync::to_seconds(now - sync::host_time(stored->at_ns));
  return stored->clock == clock_ ? stored->account.recovered(passed_s - kAhead_s) : stored->account;
}

void DoseFile::save(const DwellAccount& account, sync::HostTime now) {
  const sync::Nanoseconds passed = now - written_at_;
  if (passed >= sync::Nanoseconds(0) && passed < kPeriod) return;
  // The stored exposure recovers by itself, because its time is stored, too.
  const DwellAccount stored = written_.recovered(sync::to_seconds(passed) - kAhead_s);
  if (account.dose_s <= stored.dose_s && account.cold_s <= stored.cold_s) return;
  if (!open(true)) return;
  std::array<char, kBytes> line;
  line.fill(' ');
  const int size = std::snprintf(line.data(), line.size(),
                                 "tactus_dose 1 %" PRId32 " %" PRId64 " %" PRId64 " %" PRId64 " %d %d", clock_,
                                 sync::to_ns(now), microseconds(account.dose_s), microseconds(account.cold_s),
                                 account.warm_limited ? 1 : 0, account.cold_limited ? 1 : 0);
  line[static_cast<std::size_t>(size)] = ' ';
  line.back() = '\n';
  if (pwrite(file_, line.data(), line.size(), 0) != static_cast<ssize_t>(line.size())) {
    refuse(std::string("cannot be stored (") + std::strerror(errno) +
           "); free space, or choose another --exposure");
    return;
  }
  written_ = account;
  written_at_ = now;
}

}  // namespace tactus::thermal
