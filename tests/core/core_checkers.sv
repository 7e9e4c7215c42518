// Every checker that halfplane_core has, bound as docs/core.md says. Tests send wrong words: these are not failures.
bind command_decoder command_stream_checker #(.CHECKS_ERRORS(0)) u_command_stream_checker (.*);
bind raster_top primitive_stream_checker u_primitive_stream_checker (.*);
