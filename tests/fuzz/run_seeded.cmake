# Runs FUZZER on SEEDS and on RUNS inputs made from them, the same each time. Findings go to FOUND.
# For this the seeds are named in order, as a folder lists them in any; FOUND is not read again by the clock; and no
# input is made from compared values, as addresses of memory are among these.
file(GLOB seeds "${SEEDS}/*")
list(JOIN seeds "," seeds)
file(REMOVE_RECURSE "${FOUND}")
file(MAKE_DIRECTORY "${FOUND}")
execute_process(
  COMMAND "${FUZZER}" -runs=${RUNS} -seed=2009 -max_len=4096 -timeout=20 -reload=0 -use_cmp=0
    -print_final_stats=1 "-artifact_prefix=${FOUND}/" "-seed_inputs=${seeds}" "${FOUND}"
  RESULT_VARIABLE status ERROR_VARIABLE log)
if(NOT status EQUAL 0)
  message(NOTICE "${log}")  # as it is; an error's text would be laid out anew
  message(FATAL_ERROR "An input was handled wrongly. To see it again: ${FUZZER} FILE, with the file named above")
endif()
message("${RUNS} inputs, none refused wrongly")
