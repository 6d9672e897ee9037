#pragma once

#include <string>
#include <vector>

#include "b3_abi.h"
#include "reply.h"
#include "session.h"

namespace tandem::pybullet {

/// Runs the commands of one plugin instance; docs/pybullet.md lists them.
class Commands {
 public:
  explicit Commands(Session& session) : session_(session) {}

  /// Never throws. A refused command changes nothing, but consumes what was sent for it: `data`,
  /// and the peers and agreements of a mesh.
  Reply run(const b3::PluginArguments& arguments) noexcept;

 private:
  struct Peer {
    std::uint32_t id;
    std::string address, key;
  };
  struct Item {
    std::string key, value;
  };
  using Function = void (Commands::*)(Words&, Reply&);
  struct Entry {
    const char* name;
    Function function;
    bool takes_data;
  };
  static const Entry kTable[];

  Reply runWords(const b3::PluginArguments& arguments);
  std::vector<double> takeDoubles();

  void version(Words&, Reply&);
  void data(Words&, Reply&);
  void device(Words&, Reply&);
  void site(Words&, Reply&);
  void peer(Words&, Reply&);
  void agree(Words&, Reply&);
  void mesh(Words&, Reply&);
  void meshStatus(Words&, Reply&);
  void meshExplain(Words&, Reply&);
  void key(Words&, Reply&);
  void link(Words&, Reply&);
  void share(Words&, Reply&);
  void unshare(Words& words, Reply& reply);
  void grab(Words&, Reply&);
  void release(Words&, Reply&);
  void grip(Words&, Reply&);
  void obstacle(Words&, Reply&);
  void connect(Words&, Reply&);
  void proxy(Words&, Reply&);
  void hand(Words&, Reply&);
  void force(Words&, Reply&);
  void read(Words&, Reply&);
  void contacts(Words&, Reply&);
  void warnings(Words&, Reply&);
  void push(Words&, Reply&);
  void pop(Words&, Reply&);
  void close(Words&, Reply&);

  Session& session_;
  std::vector<int> data_;    // sent before the command that uses them
  std::vector<Peer> peers_;  // sent before the mesh that they are for
  std::vector<Item> agreements_;
};

}  // namespace tandem::pybullet
