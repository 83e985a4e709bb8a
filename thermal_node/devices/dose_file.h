// The exposure of the skin in a small file, so that it survives a restart of the process. The file belongs to the
// user of the process and no other may write it; a file that does not is not believed.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "sync/time/time.h"
#include "thermal_node/skin/dwell.h"

namespace tactus::thermal {

// The file that a program of this name uses by default: NAME.dose in its folder; empty in virtual time, which has
// no person.
std::string default_dose_file(const std::string& folder, const std::string& name);

class DoseFile {
 public:
  // A display holds its command for this time after its sender has ended: the exposure that save() counts ahead.
  // It covers Device::kSilence and kPeriod.
  static constexpr double kAhead_s = 0.4;
  // Smallest time between two writes.
  static constexpr sync::Nanoseconds kPeriod{100'000'000};

  // path: empty: nothing is stored. clock: id of the clock of all times (sync/bus/identity.h). Nothing is created
  // before the first exposure.
  DoseFile(std::string path, std::int32_t clock) : path_(std::move(path)), clock_(clock) {}
  ~DoseFile();
  DoseFile(const DoseFile&) = delete;
  DoseFile& operator=(const DoseFile&) = delete;

  // The exposure that an earlier process has stored, with the recovery since then if it was stored by the same
  // clock; none without a file; a full one if the file cannot be believed (see problem()).
  DwellAccount load(sync::HostTime now);

  // account: as it will be in kAhead_s. Writes it if it is a longer exposure than before, at most every kPeriod;
  // recovery needs no write. One small write, without a lock and without waiting for the disk.
  void save(const DwellAccount& account, sync::HostTime now);

  // One sentence for the user: the file cannot be read or written; empty: none.
  const std::string& problem() const { return problem_; }
  const std::string& path() const { return path_; }

 private:
  bool open(bool create);
  bool refuse(const std::string& reason);

  std::string path_;
  std::int32_t clock_;
  int file_ = -1;
  bool refused_ = false;
  DwellAccount written_;
  sync::HostTime written_at_{};
  std::string problem_;
};

}  // namespace tactus::thermal
