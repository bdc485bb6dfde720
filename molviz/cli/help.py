"""``molviz help``: pages that belong to no single command."""

import click

from molviz.errors import OptionError, expected_instead
from molviz.model.selection import grammar

SELECTIONS = "selections"


@click.command("help")
@click.argument("topic", required=False, metavar="[TOPIC]")
@click.pass_context
def help_command(ctx: click.Context, topic: str | None) -> None:
    """Explain the language of selections, or a command.

    \b
    Examples:
      molviz help selections
      molviz help draw
    """
    group = ctx.find_root()
    if topic == SELECTIONS:
        click.echo(grammar(), nl=False)
        return
    assert isinstance(group.command, click.Group)
    command = group.command if topic is None else group.command.get_command(group, topic)
    if command is None:
        topics = (SELECTIONS, *group.command.list_commands(group))
        expected = expected_instead(str(topic), topics, f"one of {', '.join(topics)}")
        raise OptionError(f"no page on {topic!r}; {expected}")
    shown = group if topic is None else click.Context(command, info_name=topic, parent=group)
    click.echo(command.get_help(shown))
