# What the program's pages need besides HTML: scripts of ours in web/, and three.js for views in
# three dimensions. npm fetches it, and what puts it into one script, into the build folder, in the
# versions and with the checksums of web/package-lock.json. All of it becomes part of the program.
option(SOFTFORCE_WEB "Give the pages a 3-D view; npm fetches three.js for it while building" ON)

if(SOFTFORCE_WEB)
  find_program(SOFTFORCE_NPM npm)
  if(NOT SOFTFORCE_NPM)
    message(FATAL_ERROR "npm was not found. It fetches three.js, with which report.html shows the body in three dimensions. Install "
                        "it (on Debian 12: apt-get install npm), or build without that view: cmake -DSOFTFORCE_WEB=OFF …")
  endif()
endif()

set(softforce_web_dir ${PROJECT_BINARY_DIR}/web)

# softforce_embed(TARGET FUNCTION HEADER TEXT): adds a source with FUNCTION(), which HEADER declares in softforce::report and which
# returns the contents of the file TEXT; nothing if TEXT is left out.
function(softforce_embed target function header)
  set(text "")
  if(ARGC GREATER 3)
    get_filename_component(text ${ARGV3} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
  endif()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cc)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DTEXT=${text} -DSOURCE=${source} -DFUNCTION=${function} -DHEADER=${header}
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
    DEPENDS ${text} ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()

# softforce_bundle(NAME IMPORTS…): the script ${softforce_web_dir}/NAME.bundle.js, made of web/NAME.js and all it imports; those of
# ours, from web/, are named.
function(softforce_bundle name)
  set(source ${PROJECT_SOURCE_DIR}/web/${name}.js)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/web/ OUTPUT_VARIABLE imports)
  set(bundle ${softforce_web_dir}/${name}.bundle.js)
  add_custom_command(OUTPUT ${bundle}
    COMMAND ${CMAKE_COMMAND} -E copy ${source} ${imports} ${softforce_web_dir}
    COMMAND ${softforce_web_dir}/node_modules/.bin/esbuild ${softforce_web_dir}/${name}.js --bundle --minify --format=iife
            --target=es2020 --charset=ascii --legal-comments=inline --log-level=warning --outfile=${bundle}
    DEPENDS ${source} ${imports} softforce_three ${softforce_web_dir}/fetched
    COMMENT "Putting web/${name}.js and three.js into one script"
    VERBATIM)
endfunction()

if(SOFTFORCE_WEB)
  set(manifests ${PROJECT_SOURCE_DIR}/web/package.json ${PROJECT_SOURCE_DIR}/web/package-lock.json ${PROJECT_SOURCE_DIR}/web/.npmrc)
  add_custom_command(OUTPUT ${softforce_web_dir}/fetched
    COMMAND ${CMAKE_COMMAND} -E make_directory ${softforce_web_dir}
    COMMAND ${CMAKE_COMMAND} -E copy ${manifests} ${softforce_web_dir}
    COMMAND ${CMAKE_COMMAND} -E chdir ${softforce_web_dir} ${SOFTFORCE_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${softforce_web_dir}/fetched
    DEPENDS ${manifests}
    COMMENT "Fetching three.js with npm; without network: cmake -DSOFTFORCE_WEB=OFF"
    VERBATIM)
  add_custom_target(softforce_three DEPENDS ${softforce_web_dir}/fetched)
endif()
