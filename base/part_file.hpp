#pragma once
/// \file Output files that appear whole or not at all, and locks between processes of Bough.
#include <string>
#include <system_error>

namespace bough {

/// The file that writing to `path` reaches: symbolic links followed, whether it exists or not. `failed` is set where a
/// link cannot be followed (a circle, or a link of another user in a shared folder) and then `path` is returned.
std::string find_target(const std::string& path, std::error_code& failed);

/// A new file next to the target of `path`, NAME.bough-part-PID, that replaces it when complete. It is made with
/// O_EXCL and O_NOFOLLOW and locked while it is open; parts of the same name whose process is gone are removed first.
/// Removed by its destructor, and by remove_parts. What the call has read is refused (note_output).
class PartFile {
 public:
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Why the file could not be made, or what went wrong since.
  const std::error_code& error() const { return error_; }
  /// The name to write to; the target's is get_target.
  const std::string& get_name() const { return name_; }
  /// The name that the complete file gets.
  const std::string& get_target() const { return target_; }
  /// File descriptor of the file that is written.
  int get_descriptor() const { return descriptor_; }

  /// Appends; false, with error(), when the file did not take all of it.
  bool write(const char* data, std::size_t size);
  /// Asks for the bytes so far to go to the disk while the caller goes on: commit() waits for less.
  void start_sync();
  /// Syncs the bytes, renames the file and syncs its folder: the file appears now, with the permissions of the old one,
  /// and survives a power cut. False, with error(), and then the old one is untouched.
  bool commit();
  /// Renames as commit() does, but the file stays open and locked as by lock_file.
  bool publish();
  /// Closes and removes.
  void abandon();

 private:
  bool fail();
  bool replace_target();
  std::string name_, target_;
  int descriptor_ = -1, slot_ = -1;
  bool is_published_ = false;
  std::error_code error_;
};

/// Syncs the folder of a file: its name survives a power cut. False, with errno; true where the file system syncs no
/// folders.
bool sync_folder(const std::string& path);

/// Removes every part that this process has open. Async-signal-safe.
void remove_parts() noexcept;

enum class LockState { Held, Busy, Unsupported };
/// Locks a file for as long as the descriptor, open for writing, stays open; no other program's reading is hindered (a
/// lock of the open file description on one byte far after the end). Processes forked share it.
LockState lock_file(int descriptor);
/// Returns true if a process holds the lock; false if that is not known.
bool is_file_locked(const std::string& path);

}  // namespace bough
