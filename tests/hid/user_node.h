#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace tandem::test {

/// A device node of Linux played by this process. This program's own open() and ioctl() know its
/// path and pass all others to the system. read(), write() and poll() are the system's, on a socket
/// that keeps messages apart as a node does. Thread safe.
class UserNode {
 public:
  virtual ~UserNode();
  UserNode(const UserNode&) = delete;
  UserNode& operator=(const UserNode&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  void unplug();
  void plugIn();
  /// Makes each attempt to open the node fail with this error; 0: none.
  void refuseToOpen(int error);

  /// Used by open() and ioctl() of this program; returns -1 and sets errno like the system.
  [[nodiscard]] int openFile();
  [[nodiscard]] virtual int control(unsigned long request, void* argument) = 0;
  /// Finds the node with this path, or the node of this file.
  [[nodiscard]] static UserNode* find(const std::string& path);
  [[nodiscard]] static UserNode* find(int file);

 protected:
  /// `path` must be one that no real system has. The socket has the options `socket_options`.
  UserNode(std::string path, int socket_options);
  /// Waits up to `wait` [s] for a message of an open file. Returns false if none comes.
  [[nodiscard]] bool waitForMessage(double wait) const;
  /// Sets errno to `reason` and returns -1.
  [[nodiscard]] static int failWith(int reason);

  std::mutex mutex_;
  int ours_ = -1;  ///< the device's end of the socket

 private:
  std::string path_;
  int socket_options_;
  int theirs_ = -1;  ///< end of the socket for the open files
  int error_ = 0;    ///< of each attempt to open the node; 0: none
  std::vector<int> files_;
};

}  // namespace tandem::test
