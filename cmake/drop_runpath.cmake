# CPack runs this on the packages' files. Libraries in the system's own folders need no run path.
file(GLOB_RECURSE files LIST_DIRECTORIES FALSE "${CPACK_TEMPORARY_DIRECTORY}/*")
list(FILTER files INCLUDE REGEX "/(bin/tandem[^/]*|libtandem_[^/]*\\.so[^/]*|tandem/[^/]*\\.so)$")
foreach(file ${files})
  if(NOT IS_SYMLINK "${file}")
    file(RPATH_REMOVE FILE "${file}")
  endif()
endforeach()
