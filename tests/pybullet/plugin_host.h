#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "stub_engine.h"

namespace tandem::test {

/// The built plugin's entry points, found as PyBullet finds them. Loaded once and never unloaded.
struct PluginEntries {
  int (*init)(b3::PluginContext*);
  void (*exit)(b3::PluginContext*);
  StubEngine::Tick pre_tick, post_tick;
  int (*execute)(b3::PluginContext*, const b3::PluginArguments*);

  static const PluginEntries& get() {
    static const PluginEntries entries = load();
    return entries;
  }

 private:
  template <typename Function>
  static void find(void* module, const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(dlsym(module, name));
  }
  static PluginEntries load() {
    void* const module = dlopen(TANDEM_PYBULLET_PLUGIN, RTLD_NOW | RTLD_LOCAL);
    if (!module) throw std::runtime_error(dlerror());
    PluginEntries entries{};
    find(module, "initPlugin_tandem", entries.init);
    find(module, "exitPlugin_tandem", entries.exit);
    find(module, "preTickPluginCallback_tandem", entries.pre_tick);
    find(module, "postTickPluginCallback_tandem", entries.post_tick);
    find(module, "executePluginCommand_tandem", entries.execute);
    return entries;
  }
};

struct PluginAnswer {
  int status = 0;
  std::string bytes;

  std::vector<double> doubles() const {
    std::vector<double> values(bytes.size() / sizeof(double));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};

/// A stub server with the plugin loaded.
class PluginHost {
 public:
  StubEngine engine;
  bool closes = true;  // closes the site before unloading

  PluginHost() {
    b3::PluginContext context;
    std::memset(&context, 0x5A, sizeof context);  // as in PyBullet, most of it is garbage here
    context.client = engine.client();
    context.user_pointer = nullptr;
    EXPECT_EQ(PluginEntries::get().init(&context), b3::kMagicNumber);
    user_pointer_ = context.user_pointer;
  }
  ~PluginHost() {
    if (closes) command("close");
    b3::PluginContext context{};
    context.client = engine.client();
    context.user_pointer = user_pointer_;
    const int commands = engine.commands;
    PluginEntries::get().exit(&context);
    // PyBullet's bodies may be gone already.
    EXPECT_EQ(engine.commands, commands) << "exitPlugin touches the server";
  }
  PluginHost(const PluginHost&) = delete;
  PluginHost& operator=(const PluginHost&) = delete;

  PluginAnswer ask(const std::string& text, const std::vector<int>& ints = {}, int floats = 0) {
    b3::PluginArguments arguments{};
    text.copy(arguments.text, sizeof arguments.text);
    arguments.int_count = static_cast<int>(ints.size());
    std::copy(ints.begin(), ints.end(), arguments.ints);
    arguments.float_count = floats;
    b3::PluginContext context{};
    context.client = engine.client();
    context.user_pointer = user_pointer_;
    PluginAnswer answer;
    answer.status = PluginEntries::get().execute(&context, &arguments);
    if (context.return_data) {
      EXPECT_GT(context.return_data->length, 0);
      answer.bytes.assign(context.return_data->data,
                          static_cast<std::size_t>(context.return_data->length));
    }
    return answer;
  }
  PluginAnswer askDoubles(const std::string& text, const std::vector<double>& doubles) {
    std::vector<int> ints(doubles.size() * 2);
    std::memcpy(ints.data(), doubles.data(), doubles.size() * sizeof(double));
    return ask(text, ints);
  }
  /// Runs a command that must succeed; returns its number.
  int command(const std::string& text) {
    const PluginAnswer answer = ask(text);
    EXPECT_GE(answer.status, 0) << text << ": " << answer.bytes;
    return answer.status;
  }
  /// Message of a command that must be refused.
  std::string refusal(const std::string& text) {
    const PluginAnswer answer = ask(text);
    EXPECT_LT(answer.status, 0) << text;
    EXPECT_FALSE(answer.bytes.empty()) << text;
    return answer.bytes;
  }
  std::vector<double> read() { return ask("read").doubles(); }
  std::string warnings() { return ask("warnings").bytes; }

  void step() {
    engine.step(PluginEntries::get().pre_tick, PluginEntries::get().post_tick, user_pointer_);
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) step();
  }

 private:
  void* user_pointer_ = nullptr;
};

}  // namespace tandem::test
