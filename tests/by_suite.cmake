# ctest reads this file. `test_files`: the files that gtest_discover_tests() writes. If the environment contains
# WEFT_BY_SUITE, all tests of a suite are one test of ctest, in one process. Reason: to start a test program takes up to
# 0.2 s of CPU time; for single tests, this would be a fifth of the time of `tests/run`. Skipped tests then count as
# passed; the log names them.
foreach(include IN LISTS test_files)
  string(REPLACE "_include.cmake" "_tests.cmake" file "${include}")
  if(NOT EXISTS "${file}" AND file MATCHES "_slow\\[[0-9]+\\]_tests\\.cmake$")
    continue()  # tests/run builds slow programs only if its arguments select tests
  endif()
  if(NOT EXISTS "${file}" OR NOT DEFINED ENV{WEFT_BY_SUITE})
    include("${include}")
    continue()
  endif()
  file(READ "${file}" text)
  string(REGEX MATCH "\\]=\\] +([^ ]*/test_[a-z_]+) " program "${text}")
  set(program "${CMAKE_MATCH_1}")
  string(REGEX MATCH "WORKING_DIRECTORY ([^ ]+)" folder "${text}")
  set(folder "${CMAKE_MATCH_1}")
  string(REGEX MATCH "LABELS ([a-z]+) TIMEOUT" label "${text}")
  set(label "${CMAKE_MATCH_1}")
  string(REGEX MATCHALL "--gtest_filter=[^].]+" suites "${text}")
  list(REMOVE_DUPLICATES suites)
  foreach(suite IN LISTS suites)
    string(REPLACE "--gtest_filter=" "" suite "${suite}")
    add_test("${suite}.*" "${program}" "--gtest_filter=${suite}.*")
    set_tests_properties("${suite}.*" PROPERTIES WORKING_DIRECTORY "${folder}" LABELS "${label}" TIMEOUT 1800)
  endforeach()
endforeach()
