# MuJoCo as the target tandem_mujoco, if it is installed. Debian's own config of 2.2.2 names a folder that does not exist.
find_path(TANDEM_MUJOCO_INCLUDE mujoco/mujoco.h)
find_library(TANDEM_MUJOCO_LIBRARY mujoco)
mark_as_advanced(TANDEM_MUJOCO_INCLUDE TANDEM_MUJOCO_LIBRARY)
if(TANDEM_MUJOCO_INCLUDE AND TANDEM_MUJOCO_LIBRARY AND NOT TARGET tandem_mujoco)
  add_library(tandem_mujoco INTERFACE IMPORTED GLOBAL)
  target_include_directories(tandem_mujoco SYSTEM INTERFACE "${TANDEM_MUJOCO_INCLUDE}")
  target_link_libraries(tandem_mujoco INTERFACE "${TANDEM_MUJOCO_LIBRARY}")
endif()
