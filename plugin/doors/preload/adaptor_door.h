#pragma once

#include <cstddef>

/// \file
/// What the interposer asks of an adaptor library: plain C, as the two are built apart and meet in
/// a process of somebody else's. Nothing here throws. The thread that makes, steps and ends the
/// world calls; of one world only, from take to end.
extern "C" {

/// Width of btScalar that the adaptor was built for [bytes]. Asked first.
using TandemPreloadScalarBytes = std::size_t (*)();

/// Reads the config file. `process` is the name that the interposer compared with the config's key.
/// True if it can be used; else one line on stderr has said why.
using TandemPreloadOpen = bool (*)(const char* config, const char* process);

/// A world was made, the `number`th of the process, counted from 1: true if it is the config's. A
/// derived world is not complete yet.
using TandemPreloadTakeWorld = bool (*)(void* world, int number);

/// Around each of its steps: dt [s] is what stepSimulation() was told, and `sub_steps` of
/// `fixed_step` [s] what it did.
using TandemPreloadBeforeStep = void (*)();
using TandemPreloadAfterStep = void (*)(double dt, int max_sub_steps, double fixed_step,
                                        int sub_steps);

/// A body or another collision object is about to be taken out of it.
using TandemPreloadObjectLeaves = void (*)(void* object);

/// It is about to end.
using TandemPreloadEndWorld = void (*)();

/// All of it: the one symbol of an adaptor library, kTandemPreloadDoor.
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
