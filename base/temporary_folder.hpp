#pragma once
/// \file A folder for files of one call of the program.
#include <string>

namespace bough {

/// Private folder in TMPDIR, by default /tmp, removed with all its files at the end of the object's life. One that the
/// process does not live to remove stays.
class TemporaryFolder {
 public:
  /// \param name     first part of the folder's name, as "bough-fmu".
  /// \param purpose  for the message, as "the FMU".
  /// \throws ComputationError "cli.no-temporary-folder".
  TemporaryFolder(const std::string& name, const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Returns the path of the folder, without a slash at its end.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace bough
