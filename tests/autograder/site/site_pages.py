"""Reads a page's elements: enough to ask which attributes it has."""

from html.parser import HTMLParser


class Elements(HTMLParser):
    """All start tags of a page with their attributes."""

    def __init__(self, html):
        super().__init__()
        self.tags = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def values(self, attribute):
        return [attributes[attribute] for _, attributes in self.tags if attributes.get(attribute)]
