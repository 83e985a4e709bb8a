// The main function of a reader program: confines the process, then parses one foreign file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sync/sandbox/records.h"
#include "sync/sandbox/sandbox.h"

namespace tactus::sync {

using SendRecord = std::function<void(char kind, std::span<const std::uint8_t> content)>;

// Answers --help and rejects an option: the exit status, or none when the arguments are not options. help: the text of --help.
std::optional<int> reader_options(int argc, char** argv, const std::string& help);

// Calls `read` in the confined process; the records that it sends go to standard output. An exception becomes a record
// 'E' with one clause, and so does a measure of confinement that the kernel offers and refuses; then nothing is read. Returns the
// exit status.
int reader_main(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits,
                const std::function<void(const SendRecord&)>& read);

// The same for the program of a ReaderSession: calls `read` for each request, until standard input ends. Its result is the
// answer.
int reader_session_main(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits,
                        const std::function<std::vector<std::uint8_t>(std::span<const std::uint8_t>)>& read);

}  // namespace tactus::sync
