# Run by CPack on what goes into the packages: installed in the system's own folders, nobody needs to be told where
# the libraries are.
file(GLOB_RECURSE files LIST_DIRECTORIES FALSE "${CPACK_TEMPORARY_DIRECTORY}/*")
list(FILTER files INCLUDE REGEX "/(bin/tandem[^/]*|libtandem_[^/]*\\.so[^/]*|tandem/[^/]*\\.so)$")
foreach(file ${files})
  if(NOT IS_SYMLINK "${file}")
    file(RPATH_REMOVE FILE "${file}")
  endif()
endforeach()
