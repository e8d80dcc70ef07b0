#pragma once
/// \file Value references of the variables of an FMU, and the identity of its resources.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bough::fmi {

/// Kind of a variable: the upper byte of its value reference. The lower bytes are the index in bough.h.
enum class VariableKind : std::uint32_t { Time = 0, Input, Output, Parameter, State, Derivative, EventIndicator };

constexpr std::uint32_t kMaxIndex = 0xffffff;

/// Composes a value reference; index <= kMaxIndex.
constexpr std::uint32_t make_reference(VariableKind kind, std::size_t index) {
  return static_cast<std::uint32_t>(kind) << 24 | static_cast<std::uint32_t>(index);
}

/// Files of resources/ that belong to the FMU, in the order of their names; the first line names the layout.
constexpr const char* kManifest = "manifest.txt";
constexpr const char* kManifestHead = "bough-fmu 1";
/// The system file in resources/.
constexpr const char* kSystemFile = "system.toml";

struct Resource {
  std::string name, bytes;
};

/// Returns the text of the manifest. \param version  of the library.
std::string make_manifest(const std::vector<Resource>& resources, const std::string& version);

/// Returns guid (FMI 2) or instantiation token (FMI 3): a hash of the manifest and of the bytes of every resource.
std::string calc_token(const std::string& manifest, const std::vector<Resource>& resources);

/// Calculates the token of an unpacked FMU. \param folder  resources/. \throws InputError "fmu.resources".
std::string calc_token(const std::string& folder);

}  // namespace bough::fmi
