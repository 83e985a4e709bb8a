// The main function of a reader program: confines the process, then parses one foreign file.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "sync/sandbox/records.h"
#include "sync/sandbox/sandbox.h"

namespace tactus::sync {

using SendRecord = std::function<void(char kind, std::span<const std::uint8_t> content)>;

// Answers --help and rejects an option: the exit status, or none when the arguments are not options. help: the text of --help.
std::optional<int> reader_options(int argc, char** argv, const std::string& help);

// Calls `read` in the confined process; the records that it sends go to standard output. An exception becomes a record
// 'E' with one clause. Returns the exit status.
int reader_main(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits,
                const std::function<void(const SendRecord&)>& read);

}  // namespace tactus::sync
