# Writes a ctest for each suite of a GoogleTest program, which runs the suite's cases in one process:
#
#   cmake -D PROGRAM=path -D NAME=prefix -D LIST=file -D LEAVE_OUT=regex -D ALONE=bool -P list_suites.cmake
#
# Cases whose name, "<prefix>.<suite>.<case>", matches LEAVE_OUT do not run. LIST is a script for ctest.
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "  # [^\n]*" "" listed "${listed}")  # values of parameters, which may hold any character
string(REPLACE "\n" ";" lines "${listed}")

# Adds the suite that was read, unless all its cases are left out.
set(script "")
macro(finish_suite)
  if(runs)
    list(JOIN left_out ":" left_out)
    string(APPEND script "add_test([[${NAME}.${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*-${left_out}]])\n"
      "set_tests_properties([[${NAME}.${suite}]] PROPERTIES TIMEOUT 900 RUN_SERIAL ${ALONE})\n")
  endif()
  set(runs OFF)
  set(left_out "")
endmacro()

foreach(line ${lines})
  if(line MATCHES "^([^ ]+)\\.$")
    finish_suite()
    set(suite "${CMAKE_MATCH_1}")
  elseif(line MATCHES "^  ([^ ]+)$")
    set(case "${suite}.${CMAKE_MATCH_1}")
    if(LEAVE_OUT AND "${NAME}.${case}" MATCHES "${LEAVE_OUT}")
      list(APPEND left_out "${case}")
    else()
      set(runs ON)
    endif()
  endif()
endforeach()
finish_suite()
file(WRITE "${LIST}" "${script}")
