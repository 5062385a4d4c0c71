# Program version and git revision, for the results' `source` attribute.
# The revision is written at build time and only when it changed, so that a commit rebuilds one file.
set(MANOSCOPE_REVISION_FILE ${CMAKE_BINARY_DIR}/generated/manoscope_revision.inc)
add_custom_target(manoscope_revision
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${MANOSCOPE_REVISION_FILE}
          -DVERSION=${PROJECT_VERSION} -P ${CMAKE_SOURCE_DIR}/cmake/write_revision.cmake
  BYPRODUCTS ${MANOSCOPE_REVISION_FILE}
  COMMENT "Recording the source revision" VERBATIM)
