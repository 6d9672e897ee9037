#include <algorithm>
#include <cstdio>
#include <exception>

#include "b3_functions.h"
#include "commands.h"
#include "session.h"

// Entry points that PyBullet looks up for the postfix "_tandem". Each physics server that loads the
// plugin has its own instance. No exception leaves a function.

namespace tandem::pybullet {
namespace {

struct Instance {
  Instance(const B3Functions& functions, b3::Client client)
      : session(functions, client), commands(session) {}

  Session session;
  Commands commands;
  Reply reply;  // PyBullet reads it after the command
  b3::UserDataValue returned{};
};

Instance* instanceOf(const b3::PluginContext* context) {
  return context ? static_cast<Instance*>(context->user_pointer) : nullptr;
}

void say(const char* text, const char* what) { std::fprintf(stderr, "tandem: %s%s\n", text, what); }

}  // namespace
}  // namespace tandem::pybullet

using tandem::pybullet::Instance;
namespace b3 = tandem::pybullet::b3;

extern "C" {
#pragma GCC visibility push(default)

int initPlugin_tandem(b3::PluginContext* context);
void exitPlugin_tandem(b3::PluginContext* context);
int preTickPluginCallback_tandem(b3::PluginContext* context);
int postTickPluginCallback_tandem(b3::PluginContext* context);
int executePluginCommand_tandem(b3::PluginContext* context, const b3::PluginArguments* arguments);

// Called directly by PyBullet and never inlined: the caller's module has the b3 functions.
[[gnu::noinline]] int initPlugin_tandem(b3::PluginContext* context) {
  const void* const caller = __builtin_return_address(0);
  constexpr int kNotLoaded = 0;  // not a magic number of any version
  try {
    tandem::pybullet::B3Functions functions;
    const std::string missing = tandem::pybullet::findB3Functions(caller, functions);
    if (!missing.empty()) {
      tandem::pybullet::say("this PyBullet cannot be used, it has no ", missing.c_str());
      return kNotLoaded;
    }
    context->user_pointer = new Instance(functions, context->client);
    return b3::kMagicNumber;
  } catch (const std::exception& error) {
    tandem::pybullet::say("not loaded: ", error.what());
    return kNotLoaded;
  } catch (...) {
    tandem::pybullet::say("not loaded: ", "of an unknown kind of error");
    return kNotLoaded;
  }
}

void exitPlugin_tandem(b3::PluginContext* context) {
  Instance* const instance = tandem::pybullet::instanceOf(context);
  if (!instance) return;
  if (instance->session.hasBodies()) {
    tandem::pybullet::say("unloaded with a site open: its bodies stay as Tandem had them, ",
                          "with m/N and without damping; `close` gives them back");
  }
  delete instance;
  context->user_pointer = nullptr;
}

int preTickPluginCallback_tandem(b3::PluginContext* context) {
  if (Instance* const instance = tandem::pybullet::instanceOf(context)) {
    instance->session.preTick();
  }
  return 0;
}

int postTickPluginCallback_tandem(b3::PluginContext* context) {
  if (Instance* const instance = tandem::pybullet::instanceOf(context)) {
    instance->session.postTick();
  }
  return 0;
}

int executePluginCommand_tandem(b3::PluginContext* context, const b3::PluginArguments* arguments) {
  Instance* const instance = tandem::pybullet::instanceOf(context);
  if (!instance || !arguments) return -TANDEM_INVALID_ARGUMENT;
  instance->reply = instance->commands.run(*arguments);
  // PyBullet refuses an answer without bytes.
  if (!instance->reply.bytes.empty()) {
    instance->returned = {instance->reply.type, static_cast<int>(instance->reply.bytes.size()),
                          instance->reply.bytes.data()};
    context->return_data = &instance->returned;
  }
  return instance->reply.status;
}

#pragma GCC visibility pop
}  // extern "C"
