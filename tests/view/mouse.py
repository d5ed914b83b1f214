"""The mouse of the browser."""

from selenium.webdriver.common.actions.action_builder import ActionBuilder


class Mouse:
    def __init__(self, browser):
        self.browser = browser

    def steps(self, *steps):
        """Each a point of the window to go to, "down" or "up"."""
        actions = ActionBuilder(self.browser, duration=40)
        for step in steps:
            if step == "down":
                actions.pointer_action.pointer_down()
            elif step == "up":
                actions.pointer_action.pointer_up()
            else:
                actions.pointer_action.move_to_location(round(step[0]), round(step[1]))
        actions.perform()

    def pull(self, start, end, count=12):
        """Goes down at the start, and on to the end."""
        way = [[a + (b - a) * k / count for a, b in zip(start, end)] for k in range(1, count + 1)]
        self.steps(start, "down", *way)
