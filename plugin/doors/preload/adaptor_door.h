#pragma once

#include <cstddef>

/// \file
/// Interface of an adaptor library to the interposer. It is plain C, because the two are built
/// apart and meet in a foreign process. No function throws. The thread that makes, steps and ends
/// the world makes the calls. They concern one world only, from takeWorld to endWorld.
extern "C" {

/// Width of the adaptor's btScalar [bytes]. Called first.
using TandemPreloadScalarBytes = std::size_t (*)();

/// Reads the config file. `process` is the name that the interposer compared with the config's key.
/// Returns false if the file is unusable, after one line on stderr.
using TandemPreloadOpen = bool (*)(const char* config, const char* process);

/// Tells that the process made its world `number`, counted from 1. Returns true if the config wants
/// that world. A derived world is not complete yet.
using TandemPreloadTakeWorld = bool (*)(void* world, int number);

/// Called before and after each step of the world. stepSimulation() got `dt` [s], and made
/// `sub_steps` sub-steps of `fixed_step` [s].
using TandemPreloadBeforeStep = void (*)();
using TandemPreloadAfterStep = void (*)(double dt, int max_sub_steps, double fixed_step,
                                        int sub_steps);

/// Called before a body or another collision object is removed from the world.
using TandemPreloadObjectLeaves = void (*)(void* object);

/// Called before the world is destroyed.
using TandemPreloadEndWorld = void (*)();

/// All functions: the only symbol of an adaptor library, kTandemPreloadDoor.
struct TandemPreloadDoor {
  TandemPreloadScalarBytes scalarBytes;
  TandemPreloadOpen open;
  TandemPreloadTakeWorld takeWorld;
  TandemPreloadBeforeStep beforeStep;
  TandemPreloadAfterStep afterStep;
  TandemPreloadObjectLeaves objectLeaves;
  TandemPreloadEndWorld endWorld;
};
}

inline constexpr const char* kTandemPreloadDoor = "tandemPreloadDoor1";
