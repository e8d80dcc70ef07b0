#pragma once
/// \file Zip archives, as FMUs are.
#include <string>
#include <vector>

namespace bough::fmu {

struct ArchiveEntry {
  std::string name;  ///< with folders, "resources/system.toml"
  std::string bytes;
  bool is_program = false;  ///< Unix permissions 0755 instead of 0644
};

/// Writes a zip archive. Equal entries give equal bytes: all have the time 1980-01-01 00:00.
///
/// \param path  is overwritten; need not exist.
/// \throws ComputationError "fmu.write".
void write_archive(const std::string& path, const std::vector<ArchiveEntry>& entries);

/// Unpacks an archive. Names that lead out of the folder are refused.
///
/// \param folder  exists.
/// \throws InputError "fmu.bad-archive", ComputationError "fmu.unpack" where the disk is full.
void extract_archive(const std::string& path, const std::string& folder);

}  // namespace bough::fmu
