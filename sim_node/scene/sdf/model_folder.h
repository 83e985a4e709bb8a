// The folder of a model, as Gazebo installs it: its model.config names one SDF file for each version of SDFormat.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace tactus::sim::sdf {

// Minor versions of SDFormat that are read: 1.4 to 1.12.
constexpr int kOldestVersion = 4, kNewestVersion = 12;

// The minor version of "1.9"; nullopt: it is not of that form.
std::optional<int> minor_version(std::string_view version);

// The file of the newest version that is read; empty when the folder has no valid model.config.
std::filesystem::path file_of_model_folder(const std::filesystem::path& folder);

}  // namespace tactus::sim::sdf
