// Confines the calling process before it parses a foreign file. Libraries that parse such files have had memory errors;
// a file that abuses one reaches nothing but the files that it may read anyway.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::sync {

struct SandboxLimits {
  // Address space. No limit in a build with sanitizers, whose shadow memory is larger than any limit.
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  int processor_s = 120;
  // The process may start threads, which are confined as well: the library that it runs works in one.
  bool threads = false;
};

// The measures that the kernel accepted.
struct Confinement {
  bool files = false;         // Landlock, Linux 5.13: no file outside the folders, no write, no TCP connection
  bool system_calls = false;  // seccomp: no socket, no new process or thread, no signal to others, no write to a file
  bool capabilities = false;  // none, except reading files of other users below the folders for root
};

// Irreversible. Call it before starting threads: the kernel confines the calling thread and its children. readable:
// folders or files that may be read; nothing else can be opened. Writing is possible only to descriptors that are open.
// A measure that the kernel does not have is left out; the limits of memory and time hold on every kernel. Check the result
// with missing_measure().
Confinement confine_process(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits);

// The measures that this kernel offers to this process. Changes nothing. Not after confine_process().
Confinement available_confinement();

// Why a process must not parse foreign files: a measure that the kernel offers was refused. One clause; empty: none was. Pure.
std::string missing_measure(const Confinement& done, const Confinement& available);

// One sentence for the user about the measures that this kernel lacks; empty: it has all. Pure.
std::string confinement_notice(const Confinement& available);

}  // namespace tactus::sync
