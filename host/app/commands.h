/* The subcommands. */
#ifndef APP_COMMANDS_H
#define APP_COMMANDS_H

#include "app/cli.h"

extern const struct cli_command command_render, command_scene, command_trace, command_bvh,
    command_devices, command_bench, command_hard, command_compare, command_cost, command_view,
    command_probe, command_shader, command_check, command_merge, command_batch;

#endif
