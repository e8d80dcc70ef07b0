#pragma once
/// \file Inputs and outputs of one call of the program, so that no output overwrites an input.
#include <string>

namespace bough {

/// While one lives, files read and files to be written are remembered by device and number (links do not hide them),
/// and note_input and note_output refuse a file that is both. The innermost counts. Without one nothing is
/// remembered: a session of Python has one for each call, and may write again what it read an hour ago.
class FileRoles {
 public:
  FileRoles();
  ~FileRoles();
  FileRoles(const FileRoles&) = delete;
  FileRoles& operator=(const FileRoles&) = delete;

  /// The file is meant to be read and written back.
  static void allow_both(const std::string& path);

 private:
  friend void note_input(const std::string& path);
  friend void note_output(const std::string& path);
  static void note(const std::string& path, bool is_input);
  struct Files;
  Files* files_;
  Files* outer_;
};

/// From now on note_input and note_output refuse files that are not in this folder or below, symbolic links followed,
/// with InputError "cli.outside-folder". For the whole process, with or without a FileRoles; empty: no limit.
void confine_files(const std::string& folder);

/// Every reader calls it with what it opens. InputError "cli.output-is-input" when the call is to write this file.
void note_input(const std::string& path);

/// Every writer calls it before a long calculation. InputError "cli.output-is-input" if the call has read this file. A
/// file that replaces the old one is another file, and may be read.
void note_output(const std::string& path);

}  // namespace bough
